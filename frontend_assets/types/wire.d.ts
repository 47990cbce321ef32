// Written by `python -m studio.server.schema` from studio/protocol/: do not edit.
// A command goes to the websocket /control as JSON text; each event comes from it as JSON text.

/** Answer to `get_actions`. */
export interface Actions {
  type: "actions";
  request: number;
  actions: OfferView[];
}

/** Add a display; with a topic, it listens with what fits the topic's publishers. */
export interface AddDisplay {
  request?: number;
  document?: string;
  id?: string;
  type: "add_display";
  kind: string;
  topic?: string;
}

/**
 * Take up texts of types, usable at once; what needs others may come first.
 *
 * Of several, those that break a rule are left out and named; one alone is refused.
 */
export interface AddInterfaces {
  request?: number;
  document?: string;
  id?: string;
  type: "add_interfaces";
  texts: Record<string, string>;
}

/** Share the class by a relay, too. */
export interface AddRelay {
  request?: number;
  document?: string;
  id?: string;
  type: "add_relay";
  line: string;
}

/** Add a message, service, action, node or launch file to a package. */
export interface AddToPackage {
  request?: number;
  document?: string;
  id?: string;
  type: "add_to_package";
  package: string;
  what: "message" | "service" | "action" | "node" | "launch_file";
  name: string;
  text?: string;
  template?: "publisher" | "subscriber" | "service_server" | "service_client" | "action_server" | "action_client" | "parameters" | "timer" | "empty";
}

/** Add a tool at the end. */
export interface AddTool {
  request?: number;
  document?: string;
  id?: string;
  type: "add_tool";
  kind: string;
  name?: string;
}

/** A type that was taken up. */
export interface AddedInterface {
  name: string;
  hash: string;
  trouble: string;
}

/** Swing the joints through their limits, or stop. */
export interface AnimateJoints {
  request?: number;
  document?: string;
  id?: string;
  type: "animate_joints";
  running: boolean;
}

/**
 * Make the edits of a problem's fix as one undo step; refused when it is no longer found.
 *
 * The three fields name the problem as in `problems`.
 */
export interface ApplyFix {
  request?: number;
  document?: string;
  id?: string;
  type: "apply_fix";
  code: string;
  sentence: string;
  label: string;
}

/** Move the joints to a named pose; joints that it does not name stay. */
export interface ApplyPose {
  request?: number;
  document?: string;
  id?: string;
  type: "apply_pose";
  key: string;
  duration_s?: number;
}

/** Change the robot to a variant as one undo step; an empty name to its state on disk. */
export interface ApplyVariant {
  request?: number;
  document?: string;
  id?: string;
  type: "apply_variant";
  name: string;
}

/** One argument of a robot, as a form shows it. */
export interface ArgumentView {
  name: string;
  file: string;
  line: number;
  default: string | null;
  value: string | null;
  shown: string;
  widget: Widget;
  is_file: boolean;
}

/** Answer to `get_arguments`; `missing`: those without which it cannot be shown. */
export interface Arguments {
  type: "arguments";
  request: number;
  path: string;
  arguments: ArgumentView[];
  missing: string[];
}

/** Give a display another name, group or place; what is None stays. */
export interface ArrangeDisplay {
  request?: number;
  document?: string;
  id?: string;
  type: "arrange_display";
  display: string;
  name?: string | null;
  group?: string | null;
  before?: string | null;
}

/** Give a group, with all that is in it, another path or place; what is None stays. */
export interface ArrangeGroup {
  request?: number;
  document?: string;
  id?: string;
  type: "arrange_group";
  group: string;
  to?: string | null;
  before?: string | null;
}

/** Ask for control, or no longer. */
export interface AskControl {
  request?: number;
  document?: string;
  id?: string;
  type: "ask_control";
  asking?: boolean;
}

/** What changes about a part. */
export type Aspect = "size" | "shape" | "color" | "pose" | "collision" | "inertia" | "motion" | "name" | "other" | "presence";

/** One of them. */
export interface BagEntry {
  path: string;
  name: string;
  begin_s: number;
  seconds: number;
  bytes: number;
  messages: number;
  files: string[];
}

/** How far a damaged or unfinished bag is read that becomes a document of its own. */
export interface BagOpening {
  type: "bag_opening";
  name: string;
  done: number | null;
}

/** How far that is; sent when it begins, a few times in a second, and when it ends. */
export interface BagWriting {
  type: "bag_writing";
  done: number | null;
}

/** Answer to `save_past` and `cut_bag`. */
export interface BagWritten {
  type: "bag_written";
  request: number;
  path: string;
  messages: number;
  bytes: number;
}

/** Answer to `list_bags`, the newest first. */
export interface Bags {
  type: "bags";
  request: number;
  folder: string;
  bags: BagEntry[];
}

/** Answer to what begins an operation: its number, by which it is reported and cancelled. */
export interface Begun {
  type: "begun";
  request: number;
  operation: number;
}

/** A moment with a name. */
export interface Bookmark {
  at_s: number;
  name: string;
}

/** The bookmarks of what is shown, by time; they are kept beside a bag's files. */
export interface Bookmarks {
  type: "bookmarks";
  bookmarks: Bookmark[];
  trouble: string;
}

/** A bridge between DDS and Zenoh, as it was started and what is behind it. */
export interface BridgeView {
  name: string;
  version: string;
  domain: number | null;
  namespace: string;
  node_count: number;
  fast_dds_count: number;
  hosts: string[];
  state: "used" | "other_domain" | "empty" | "twin";
  twin: string;
  allows: boolean;
  rules: string[];
  withheld: string[];
  withheld_count: number;
  slowed: SlowedTopics[];
  localhost_only: boolean;
}

/** A run ended: how long it took from the edit to the scene. */
export interface Built {
  type: "built";
  ok: boolean;
  duration_ms: number;
}

/** Call a service; those who follow calls receive what becomes of it. */
export interface CallService {
  request?: number;
  document?: string;
  id?: string;
  type: "call_service";
  name: string;
  service_type: string;
  text?: string;
  timeout_s?: number;
}

/** A call, and what became of it. */
export interface CallView {
  operation: number;
  name: string;
  service_type: string;
  text: string;
  state: "calling" | "answered" | "failed" | "cancelled";
  began_s: number;
  took_s: number;
  timeout_s: number;
  reply: string;
  trouble: string;
}

/** Calls, the oldest first; all that are kept, or those that changed. */
export interface Calls {
  type: "calls";
  whole: boolean;
  operations: CallView[];
}

/** Wait for the answer of a call no longer. */
export interface CancelCall {
  request?: number;
  document?: string;
  id?: string;
  type: "cancel_call";
  operation: number;
}

/** Ask a server to cancel a goal; refused when the server refuses. */
export interface CancelGoal {
  request?: number;
  document?: string;
  id?: string;
  type: "cancel_goal";
  operation: number;
}

/** End the planning that the same person asked for. */
export interface CancelPlan {
  request?: number;
  document?: string;
  id?: string;
  type: "cancel_plan";
}

/** Trigger a transition of a managed node; done when it was made, else refused. */
export interface ChangeState {
  request?: number;
  document?: string;
  id?: string;
  type: "change_state";
  node: string;
  transition: number;
}

/** The subject changed, once or several times since the last such event. */
export interface Changed {
  type: "changed";
  subject: "graph" | "log" | "diagnostics" | "goal_statuses" | "lessons" | "lesson_list" | "ticks" | "workspaces" | "runs";
}

/** Answer to `get_changes`. */
export interface Changes {
  type: "changes";
  request: number;
  files: FileChanges[];
  copies: string;
}

/** One check of a lesson, and how it stands. */
export interface CheckView {
  kind: string;
  line: string;
  values: Record<string, string>;
  ok: boolean;
  code: string;
  found: Record<string, string>;
}

/** Use this folder for a package that was not found; remembered for the workspace. */
export interface ChoosePackage {
  request?: number;
  document?: string;
  id?: string;
  type: "choose_package";
  name: string;
  folder: string;
}

/** The class as the presenter and helpers see it; only to them. */
export interface ClassState {
  type: "class_state";
  open: boolean;
  locked: boolean;
  has_password: boolean;
  join_as: "student" | "guest";
  code: string;
  addresses: string[];
  link: string;
  qr: string;
  fingerprint: string;
  only_here: boolean;
  viewers: number;
  members: MemberView[];
}

/** Close a document; refused while it has unsaved edits unless `discard`. */
export interface CloseDocument {
  request?: number;
  document?: string;
  id?: string;
  type: "close_document";
  discard?: boolean;
}

/** Receive it no more. */
export interface CloseLesson {
  request?: number;
  document?: string;
  id?: string;
  type: "close_lesson";
}

/** Forget which file was opened; what is shown stays. */
export interface CloseRvizConfig {
  request?: number;
  document?: string;
  id?: string;
  type: "close_rviz_config";
}

/** One Python file of a demo. */
export interface CodeFile {
  name: string;
  text: string;
}

/** Whole lines that were edited here and changed on disk; `line` counts from 1 in the base. */
export interface CollisionView {
  line: number;
  base: string;
  mine: string;
  theirs: string;
}

/** Answer to `get_collisions`: the first of `count` places. */
export interface Collisions {
  type: "collisions";
  request: number;
  file: string;
  places: CollisionView[];
  count: number;
  state: string;
}

/** Compare two states for everybody from now on, and follow them; None ends it. */
export interface CompareVariants {
  request?: number;
  document?: string;
  id?: string;
  type: "compare_variants";
  sides?: [Side, Side] | null;
}

/** The differences between two states. `sides` None: none are compared. */
export interface Comparison {
  type: "comparison";
  sides: [Side, Side] | null;
  busy: boolean;
  faults: string[];
  inputs: InputDifference[];
  rows: DifferenceView[];
  count: number;
  ghost: Side | null;
}

/** Ask for the completions at a place. */
export interface Complete {
  request?: number;
  document?: string;
  id?: string;
  file: string;
  offset: number;
  type: "complete";
}

/** Something that may be typed; `stops` are stretches of `insert` that the cursor visits. */
export interface Completion {
  label: string;
  kind: SubjectKind;
  insert: string;
  stops: [number, number][];
  detail: string;
  doc: string;
}

/** Completions for [start, end), the likeliest first. */
export interface Completions {
  start: number;
  end: number;
  items: Completion[];
  is_whole: boolean;
}

/** Answer to `complete`. */
export interface CompletionsAnswer {
  type: "completions";
  request: number;
  completions: Completions;
}

/** Something that a finding is about. */
export interface Concern {
  kind: "node" | "topic" | "service" | "action" | "frame" | "parameter" | "interface" | "display" | "document" | "connection" | "graphics";
  name: string;
}

/**
 * Join the ROS 2 system, if that was not done yet; done when the connection stands.
 *
 * Another place than that of now: what uses the connection lets go of it before.
 */
export interface ConnectWire {
  request?: number;
  document?: string;
  id?: string;
  address?: string;
  domain?: number | null;
  distro?: "" | "humble" | "jazzy" | "kilted";
  type: "connect_wire";
}

/** A named value of a message. */
export interface ConstantView {
  name: string;
  base: string;
  value: boolean | number | string;
  comment: string;
}

/** Whether there is a class, and who has control in it. */
export interface Control {
  type: "control";
  class_open: boolean;
  holder: string;
  name: string;
  document: string;
}

/** A control of an interactive marker. */
export interface ControlView {
  number: number;
  mode: number;
  facing: number;
  wxyz: [number, number, number, number];
  independent: boolean;
  always_visible: boolean;
  description: string;
}

/** All copies, to those who lead the class. */
export interface Copies {
  type: "copies";
  copies: CopyView[];
}

/** One copy. */
export interface CopyView {
  document: string;
  of: string;
  person: string;
  name: string;
  title: string;
  made_s: number;
  handed_s: number | null;
  changes: number;
  remark: string;
  remarked_s: number | null;
  shown: boolean;
}

/** Make a package, in the words of `ros2 pkg create`. */
export interface CreatePackage {
  request?: number;
  document?: string;
  id?: string;
  type: "create_package";
  folder: string;
  name: string;
  build_type?: "ament_python" | "ament_cmake";
  dependencies?: string[];
  node_name?: string;
  library_name?: string;
  license?: string;
  description?: string;
  maintainer_name?: string;
  maintainer_email?: string;
  contents?: "nodes" | "interfaces" | "description";
}

/** Write a part of what is shown into a bag; times are those of `time_state`. */
export interface CutBag {
  request?: number;
  document?: string;
  id?: string;
  type: "cut_bag";
  begin_s: number;
  end_s: number;
  topics?: string[];
  name?: string;
}

/** Delete a lesson that was written in the page. */
export interface DeleteLesson {
  request?: number;
  document?: string;
  id?: string;
  type: "delete_lesson";
  lesson: string;
}

/** Forget one's own pose; the joints stay where they are. */
export interface DeletePose {
  request?: number;
  document?: string;
  id?: string;
  type: "delete_pose";
  name: string;
}

/** Forget a variant; the robot stays as it is. */
export interface DeleteVariant {
  request?: number;
  document?: string;
  id?: string;
  type: "delete_variant";
  name: string;
}

/** Delete a saved view. */
export interface DeleteView {
  request?: number;
  document?: string;
  id?: string;
  type: "delete_view";
  view: string;
}

/** Answer to `get_demo_code`: the file that is run first, then those of its own package. */
export interface DemoCode {
  type: "demo_code";
  request: number;
  files: CodeFile[];
}

/** Answer to `get_demo_output`. */
export interface DemoOutput {
  type: "demo_output";
  request: number;
  run: number;
  lines: string[];
  last: number;
}

/** A demo that was started from a page. */
export interface DemoView {
  demo: string;
  state: "starting" | "running" | "stopping" | "stopped" | "ended";
  for_s: number;
  code: number;
  reason: string;
}

/** Answer to `get_demos`. */
export interface Demos {
  type: "demos";
  request: number;
  demos: DemoView[];
  elsewhere: string[];
}

/** One package of the workspace needs another one. */
export interface DependencyEdgeView {
  package: string;
  needs: string;
  kinds: string[];
}

/** Who needs whom. */
export interface DependencyGraphView {
  nodes: DependencyNodeView[];
  edges: DependencyEdgeView[];
  cycles: string[][];
}

/** A package in the graph. */
export interface DependencyNodeView {
  name: string;
  presence: "workspace" | "installed" | "ros" | "system" | "unknown";
}

/** One package that is depended on, with every tag that says so. */
export interface DependencyView {
  name: string;
  kinds: string[];
  presence: "workspace" | "installed" | "ros" | "system" | "unknown";
  line: number;
}

/** Ask where items are now, and for all that is known of a few of them. */
export interface DescribeItems {
  request?: number;
  document?: string;
  id?: string;
  type: "describe_items";
  items: ItemKeys[];
  detailed?: ItemRef[];
}

/** One value that a part reports. */
export interface DiagnosticValue {
  key: string;
  value: string;
}

/** The state that a part reported last. */
export interface DiagnosticView {
  name: string;
  hardware: string;
  level: number;
  message: string;
  values: DiagnosticValue[];
  age_s: number;
}

/** Answer to `get_diagnostics`. */
export interface DiagnosticsAnswer {
  type: "diagnostics";
  request: number;
  connected: boolean;
  parts: DiagnosticView[];
  more: number;
}

/** A line with its numbers from 1 in the text before and after, where it is in them. */
export interface DiffLineView {
  kind: "same" | "old" | "new";
  before: number | null;
  after: number | null;
  text: string;
}

/** One difference between two robots; None where one of them has no such value. */
export interface DifferenceView {
  part: string;
  what: string;
  number: number;
  one: number | string | null;
  other: number | string | null;
  unit: string;
  delta: number | null;
  percent: number | null;
}

/** Give a copy up; the next one begins with the shared robot as it is then. */
export interface DiscardCopy {
  request?: number;
  document?: string;
  id?: string;
  type: "discard_copy";
}

/** Give up what was restored at the opening; undo brings it back. */
export interface DiscardRestored {
  request?: number;
  document?: string;
  id?: string;
  type: "discard_restored";
}

/** Leave the ROS 2 system: all that went out or came in for any document ends before. */
export interface DisconnectWire {
  request?: number;
  document?: string;
  id?: string;
  type: "disconnect_wire";
}

/** Another program wrote a file: its changes were taken, and so many edits are kept unsaved. */
export interface DiskMerged {
  type: "disk_merged";
  file: string;
  kept: number;
}

/** A kind of display. */
export interface DisplayKindView {
  kind: string;
  doc: string;
  icon: string;
  types: string[];
  plugin: string;
  properties: PropertyView[];
}

/** Answer to `get_display_kinds`. */
export interface DisplayKinds {
  type: "display_kinds";
  request: number;
  kinds: DisplayKindView[];
  plugin_faults: Record<string, string>;
}

/** State of a display. */
export interface DisplayState {
  id: string;
  rate_hz: number;
  age_s: number | null;
  received: number;
  lost: number;
  remarks: Remark[];
}

/** States of all displays; sent when they change, at most twice a second. */
export interface DisplayStates {
  type: "display_states";
  states: DisplayState[];
  fixed_frame: FixedFrameState;
  fixed_frame_trouble: string;
}

/** A display as it is set. */
export interface DisplayView {
  id: string;
  kind: string;
  icon: string;
  name: string;
  group: string;
  enabled: boolean;
  topic: string;
  reliable: boolean;
  latched: boolean;
  depth: number;
  wished: ListeningView;
  values: Record<string, boolean | number | string>;
  more: PropertyView[];
}

/** The shared display settings: display, then setting, then value. */
export interface Displays {
  type: "displays";
  displays: Record<string, Record<string, boolean | number | string>>;
}

/** Answer to `get_doctor_report`. */
export interface DoctorReport {
  type: "doctor_report";
  request: number;
  html: string;
}

/** One open document in the list of them. */
export interface DocumentEntry {
  id: string;
  title: string;
  path: string;
  unsaved: boolean;
}

/** State of a document: its entry file, arguments, and how it was evaluated. */
export interface DocumentState {
  type: "document";
  id: string;
  title: string;
  path: string;
  root: string;
  arguments: Record<string, string>;
  evaluator: string;
  fallback_reason: string;
  files: string[];
  packages: Record<string, string>;
  read_only: string[];
  phase: "opening" | "ready" | "failed";
  is_bare: boolean;
  may_run: boolean;
}

/** All open documents. */
export interface Documents {
  type: "documents";
  documents: DocumentEntry[];
}

/** The number of other nodes in a domain. */
export interface DomainView {
  domain: number;
  nodes: number;
}

/** The command was carried out. */
export interface Done {
  type: "done";
  request: number;
}

/**
 * Drive at a velocity until the next command, or until none came for half a second.
 *
 * The next command for the topic replaces it; when its page is silent or gone, the robot stops.
 */
export interface Drive {
  request?: number;
  document?: string;
  id?: string;
  type: "drive";
  topic: string;
  stamped?: boolean;
  x?: number;
  y?: number;
  yaw?: number;
}

/** Ask for all parameters of a node as a file of them. */
export interface DumpParameters {
  request?: number;
  document?: string;
  id?: string;
  type: "dump_parameters";
  node: string;
}

/** Add one with the same settings, below it. */
export interface DuplicateDisplay {
  request?: number;
  document?: string;
  id?: string;
  type: "duplicate_display";
  display: string;
}

/** Write a new text at a site. All edits of one `gesture` are one undo step. */
export interface EditSite {
  request?: number;
  document?: string;
  id?: string;
  type: "edit_site";
  site: string;
  text: string;
  gesture?: string;
}

/**
 * Edit a file's text; refused when its version is no longer this one.
 *
 * The changes are in order, none overlapping, each with offsets in the text before all of them.
 * All edits of one `gesture` are one undo step. `origin`, chosen by the browser, comes back in
 * their `texts_changed`, so that it recognises its own.
 */
export interface EditText {
  request?: number;
  document?: string;
  id?: string;
  type: "edit_text";
  file: string;
  version: number;
  changes: TextChange[];
  gesture?: string;
  origin?: string;
}

/** Answer to `get_effects`, true of the last good run; without parts the text shapes nothing. */
export interface Effects {
  type: "effects";
  request: number;
  site: string;
  parts: PartEffect[];
  changed_links: string[];
  moved_links: string[];
  links_there: number;
  joints_there: number;
  counts: Record<string, number>;
  decisions: number;
  readers: Place[];
  is_cut: boolean;
}

/** End it for everybody, and delete all that is kept about them. */
export interface EndClass {
  request?: number;
  document?: string;
  id?: string;
  type: "end_class";
}

/** End one process of a launch; it is not started again by itself. */
export interface EndProcess {
  request?: number;
  document?: string;
  id?: string;
  type: "end_process";
  run: number;
  process: number;
}

/** A name and its type. */
export interface EndView {
  name: string;
  type: string;
}

/** Ask what is wrong. The Doctor listens from the first question on, and some seconds longer. */
export interface ExamineSystem {
  request?: number;
  document?: string;
  id?: string;
  renderer?: string;
  draws_by_software?: boolean;
  type: "examine_system";
}

/** Ask what there is at a router; nothing is joined or started. */
export interface ExamineWire {
  request?: number;
  document?: string;
  id?: string;
  address?: string;
  domain?: number | null;
  distro?: "" | "humble" | "jazzy" | "kilted";
  type: "examine_wire";
}

/** One shipped model; `text` describes it. */
export interface ExampleEntry {
  name: string;
  robot: string;
  text: string;
}

/** Answer to `list_examples`. */
export interface Examples {
  type: "examples";
  request: number;
  examples: ExampleEntry[];
}

/** What `ros2 run` starts by a name; `file` null: no file of the package has its code. */
export interface ExecutableView {
  name: string;
  place: string;
  language: string;
  file: string | null;
  declared_in: string;
  line: number;
  fault: string;
}

/** One thing known of an item. */
export interface FactView {
  name: string;
  value: string | boolean | number | number[];
  unit: string;
  kind: string;
}

/** One feedback message of a running goal. */
export interface FeedbackView {
  number: number;
  after_s: number;
  values: string;
}

/** One field of a message. */
export interface FieldView {
  name: string;
  base: string;
  shape: "single" | "array" | "bounded" | "sequence";
  count: number;
  string_bound: number;
  default: boolean | number | string | (boolean | number | string)[] | null;
  comment: string;
}

/** One file that has unsaved edits. */
export interface FileChanges {
  file: string;
  added: number;
  removed: number;
  hunks: DiffLineView[][];
  left_out: number;
  hindrance: string;
}

/** Ask for the places of a text in the files of the robot. */
export interface FindTexts {
  request?: number;
  document?: string;
  id?: string;
  text: string;
  match_case?: boolean;
  whole_word?: boolean;
  type: "find_texts";
}

/** Ask for the robot descriptions in the ROS system. */
export interface FindWireRobots {
  request?: number;
  document?: string;
  id?: string;
  type: "find_wire_robots";
}

/** One thing that the Doctor found. */
export interface Finding {
  code: string;
  level: "error" | "warn" | "note";
  subject: "router" | "network" | "domain" | "distribution" | "versions" | "bridges" | "nodes" | "topics" | "types" | "qos" | "services" | "parameters" | "clocks" | "rates" | "stamps" | "frames" | "displays" | "document" | "browser";
  sentence: string;
  evidence: string[];
  about: Concern[];
  mend: Mend | null;
  line: string;
  talk: Talk | null;
}

/**
 * One click that mends a Problem: `action` names it, `target` is what it works on.
 *
 * Actions: `choose_package` (target: package name), `undo` (target: empty), `open_file` (target:
 * path), `resolve_collisions` (target: path of the file), `give_arguments` (target: empty), `edit`
 * (all of `edits` and `new_files`, as one undo step that bears the label).
 */
export interface Fix {
  label: string;
  action: string;
  target: string;
  edits: Replacement[];
  new_files: NewFile[];
}

/** Whether there is such a frame, as RViz's global status has it. */
export interface FixedFrameState {
  frame: string;
  level: "ok" | "warn" | "error";
  sentence: string;
}

/** What the presenter has selected, points at and has open; see `show_focus`. */
export interface Focus {
  type: "focus";
  document: string;
  part: string;
  site: string;
  panel: string;
}

/** Answer to `list_folder`. */
export interface Folder {
  type: "folder";
  request: number;
  path: string;
  parent: string | null;
  entries: FolderEntry[];
}

/** One entry of a folder. With `openable` false comes the reason. */
export interface FolderEntry {
  name: string;
  path: string;
  kind: "folder" | "package" | "robot" | "bag" | "zip" | "file";
  openable: boolean;
  reason: string;
}

/** See what the presenter looks at from now on, or no longer. */
export interface Follow {
  request?: number;
  document?: string;
  id?: string;
  type: "follow";
  following: boolean;
}

/** Receive `changed` for a subject from now on; or no more. */
export interface FollowChanges {
  request?: number;
  document?: string;
  id?: string;
  type: "follow_changes";
  subject: "graph" | "log" | "diagnostics" | "goal_statuses" | "lessons" | "lesson_list" | "ticks" | "workspaces" | "runs";
  following?: boolean;
}

/** Keep a frame that is no link in the scene for some seconds, for a camera to follow. */
export interface FollowFrame {
  request?: number;
  document?: string;
  id?: string;
  type: "follow_frame";
  frame: string;
}

/** Receive the operations of a kind, of all pages, and their changes; or no more. */
export interface FollowOperations {
  request?: number;
  document?: string;
  id?: string;
  type: "follow_operations";
  operations: "calls" | "goals" | "publications";
  following?: boolean;
}

/** Receive changes of a node's parameters. */
export interface FollowParameters {
  request?: number;
  document?: string;
  id?: string;
  type: "follow_parameters";
  node?: string;
}

/** Take a file out of that list; the file stays. */
export interface ForgetRecent {
  request?: number;
  document?: string;
  id?: string;
  type: "forget_recent";
  path: string;
}

/** Take a run that has ended out of the list. */
export interface ForgetRun {
  request?: number;
  document?: string;
  id?: string;
  type: "forget_run";
  run: number;
}

/** Take a file out of those opened lately; answered with the list. */
export interface ForgetRvizFile {
  request?: number;
  document?: string;
  id?: string;
  type: "forget_rviz_file";
  path: string;
}

/** Give up the unsaved work on a file that is not open. */
export interface ForgetWork {
  request?: number;
  document?: string;
  id?: string;
  type: "forget_work";
  path: string;
}

/** A place, and what stands in its line from `line_column` (from 1) on. */
export interface FoundText {
  place: TextPlace;
  line: string;
  line_column: number;
  in_run: boolean;
}

/** Answer to `follow_frame`. */
export interface FrameFollowed {
  type: "frame_followed";
  request: number;
  trouble: string;
}

/** A frame of TF. */
export interface FrameView {
  name: string;
  parent: string;
  publisher: string;
  static: boolean;
  rate_hz: number;
  age_s: number | null;
  state: "fresh" | "stale" | "broken";
}

/**
 * Answer to `get_frames`, true of the robot now: ask again when something was built.
 *
 * By joint the frame of the joint in its parent link: x, y, z in m, then roll, pitch, yaw in rad.
 */
export interface Frames {
  type: "frames";
  request: number;
  revision: number;
  origins: Record<string, [number, number, number, number, number, number]>;
}

/** Follow the presenter, whatever you did before. */
export interface Gather {
  type: "gather";
  document: string;
}

/** Bring everybody to what the presenter looks at, also those who explore. */
export interface GatherAll {
  request?: number;
  document?: string;
  id?: string;
  type: "gather_all";
}

/** Ask for the actions that have a server. */
export interface GetActions {
  request?: number;
  document?: string;
  id?: string;
  type: "get_actions";
}

/** Ask for the arguments of a robot: of the open document, or of a file not yet open. */
export interface GetArguments {
  request?: number;
  document?: string;
  id?: string;
  type: "get_arguments";
  path?: string;
}

/** Ask what saving would change, file by file. */
export interface GetChanges {
  request?: number;
  document?: string;
  id?: string;
  type: "get_changes";
}

/** Ask where a file's unsaved edits collide with what another program wrote. */
export interface GetCollisions {
  request?: number;
  document?: string;
  id?: string;
  type: "get_collisions";
  file: string;
}

/** Ask for the source code of a demo. */
export interface GetDemoCode {
  request?: number;
  document?: string;
  id?: string;
  type: "get_demo_code";
  demo: string;
}

/** Ask what a demo printed, in its last run. */
export interface GetDemoOutput {
  request?: number;
  document?: string;
  id?: string;
  type: "get_demo_output";
  demo: string;
  run?: number;
  after?: number;
}

/** Ask which demos run. */
export interface GetDemos {
  request?: number;
  document?: string;
  id?: string;
  type: "get_demos";
}

/** Ask for the states of all parts; the topic is subscribed from the first such request on. */
export interface GetDiagnostics {
  request?: number;
  document?: string;
  id?: string;
  type: "get_diagnostics";
}

/** Ask for the kinds of displays. */
export interface GetDisplayKinds {
  request?: number;
  document?: string;
  id?: string;
  type: "get_display_kinds";
}

/** Ask for the same as one HTML file. */
export interface GetDoctorReport {
  request?: number;
  document?: string;
  id?: string;
  renderer?: string;
  draws_by_software?: boolean;
  type: "get_doctor_report";
  language?: "en" | "de";
}

/** Ask for the effects of a site on the robot of the last good run. */
export interface GetEffects {
  request?: number;
  document?: string;
  id?: string;
  type: "get_effects";
  site: string;
}

/** Ask for the frames of the joints of the last good robot; links follow from the positions. */
export interface GetFrames {
  request?: number;
  document?: string;
  id?: string;
  type: "get_frames";
}

/** Ask for the states of all goals of an action, those of others too. */
export interface GetGoalStatuses {
  request?: number;
  document?: string;
  id?: string;
  type: "get_goal_statuses";
  name: string;
}

/** Ask who is there, unless that is known already. */
export interface GetGraph {
  request?: number;
  document?: string;
  id?: string;
  type: "get_graph";
  known?: number;
}

/** Ask what a type is made of, down to its numbers and texts. */
export interface GetInterface {
  request?: number;
  document?: string;
  id?: string;
  type: "get_interface";
  name: string;
  with_text?: boolean;
}

/** Ask who has done which step of a lesson. */
export interface GetLessonTable {
  request?: number;
  document?: string;
  id?: string;
  type: "get_lesson_table";
  lesson: string;
}

/** Ask for the text of a lesson. */
export interface GetLessonText {
  request?: number;
  document?: string;
  id?: string;
  type: "get_lesson_text";
  lesson: string;
  language?: string;
}

/** Ask which lessons there are. */
export interface GetLessons {
  request?: number;
  document?: string;
  id?: string;
  type: "get_lessons";
}

/** A link that opens this robot with its arguments and unsaved edits, and a bag's moment. */
export interface GetLink {
  request?: number;
  document?: string;
  id?: string;
  type: "get_link";
  look?: LinkLook;
}

/** Ask for the lines after one; `/rosout` is subscribed from the first such request on. */
export interface GetLog {
  request?: number;
  document?: string;
  id?: string;
  type: "get_log";
  after?: number;
}

/** Ask in which state the managed nodes are; each of them is asked. */
export interface GetManaged {
  request?: number;
  document?: string;
  id?: string;
  type: "get_managed";
}

/** Ask for the masses of the links of the last good robot, and the volumes of their shapes. */
export interface GetMasses {
  request?: number;
  document?: string;
  id?: string;
  type: "get_masses";
}

/** Ask what there is in the domain of your own nodes. */
export interface GetMyGraph {
  request?: number;
  document?: string;
  id?: string;
  type: "get_my_graph";
}

/** Ask what a node has. */
export interface GetNode {
  request?: number;
  document?: string;
  id?: string;
  type: "get_node";
  name: string;
}

/** Ask for the domain and the credentials of your own nodes: the same ones each time. */
export interface GetNodeAccess {
  request?: number;
  document?: string;
  id?: string;
  type: "get_node_access";
}

/** Ask where a part of the last good run comes from: `link:<name>`, `joint:<name>` ... */
export interface GetOrigin {
  request?: number;
  document?: string;
  id?: string;
  type: "get_origin";
  part: string;
}

/** Ask for what the files of the robot define: includes, macros, properties, args. */
export interface GetOutline {
  request?: number;
  document?: string;
  id?: string;
  type: "get_outline";
}

/** Ask which nodes have parameters. */
export interface GetParameterNodes {
  request?: number;
  document?: string;
  id?: string;
  type: "get_parameter_nodes";
}

/** Ask for all parameters of a node, with their descriptors. */
export interface GetParameters {
  request?: number;
  document?: string;
  id?: string;
  type: "get_parameters";
  node: string;
}

/** Ask for all places that use the name at a place. */
export interface GetReferences {
  request?: number;
  document?: string;
  id?: string;
  file: string;
  offset: number;
  type: "get_references";
}

/** Ask for the changes that a renaming to `name` would make. */
export interface GetRenaming {
  request?: number;
  document?: string;
  id?: string;
  file: string;
  offset: number;
  type: "get_renaming";
  name: string;
}

/** Ask for the lines of a run after one that is known; 0: for all that are kept. */
export interface GetRunOutput {
  request?: number;
  document?: string;
  id?: string;
  type: "get_run_output";
  run: number;
  after?: number;
}

/** Ask for all runs; `changed` of the subject `runs` says when to ask again. */
export interface GetRuns {
  request?: number;
  document?: string;
  id?: string;
  type: "get_runs";
}

/** Ask for the text of an `.rviz` file with all that is shown. */
export interface GetRvizText {
  request?: number;
  document?: string;
  id?: string;
  type: "get_rviz_text";
  view?: ViewValues | null;
  page?: string;
  rviz2?: boolean;
}

/** Ask for the view and the page settings that the `.rviz` file starts a page with. */
export interface GetRvizView {
  request?: number;
  document?: string;
  id?: string;
  type: "get_rviz_view";
}

/** Ask for the time now; /clock is subscribed for some seconds after. */
export interface GetSceneTime {
  request?: number;
  document?: string;
  id?: string;
  type: "get_scene_time";
}

/** Ask for a number of a topic's messages over a range, as few values as a picture can show. */
export interface GetSeries {
  request?: number;
  document?: string;
  id?: string;
  type: "get_series";
  topic: string;
  path: string;
  begin_s: number;
  end_s: number;
  columns: number;
}

/** Ask for the services that have a server. */
export interface GetServices {
  request?: number;
  document?: string;
  id?: string;
  type: "get_services";
}

/** Ask for the text of a file as it is edited; `texts_changed` follows its changes. */
export interface GetText {
  request?: number;
  document?: string;
  id?: string;
  type: "get_text";
  file: string;
}

/** Ask for the frames, and for the pose of one in another if both are named. */
export interface GetTf {
  request?: number;
  document?: string;
  id?: string;
  type: "get_tf";
  frame?: string;
  seen_from?: string;
  pose_only?: boolean;
}

/** Ask where a topic has messages; an empty one means all together. */
export interface GetTimeMarks {
  request?: number;
  document?: string;
  id?: string;
  type: "get_time_marks";
  topic?: string;
  begin_s: number;
  end_s: number;
  bins: number;
}

/** Ask for errors and warnings of `/rosout` and `/diagnostics` in what is shown. */
export interface GetTimeTicks {
  request?: number;
  document?: string;
  id?: string;
  type: "get_time_ticks";
}

/** Ask for the kinds of tools. */
export interface GetToolKinds {
  request?: number;
  document?: string;
  id?: string;
  type: "get_tool_kinds";
}

/** Ask who publishes a topic and who subscribes to it, how, and what keeps them apart. */
export interface GetTopicEnds {
  request?: number;
  document?: string;
  id?: string;
  type: "get_topic_ends";
  topic: string;
}

/** Ask for the rates of topics; they are measured for some seconds, so ask every second. */
export interface GetTopicRates {
  request?: number;
  document?: string;
  id?: string;
  type: "get_topic_rates";
  topics: string[];
}

/** Ask for the topics, and the display that shows each. */
export interface GetTopics {
  request?: number;
  document?: string;
  id?: string;
  type: "get_topics";
}

/** The expanded URDF of the last good run. */
export interface GetUrdf {
  request?: number;
  document?: string;
  id?: string;
  type: "get_urdf";
}

/** Ask for the differences between the present URDF and that of the files on disk. */
export interface GetUrdfChanges {
  request?: number;
  document?: string;
  id?: string;
  type: "get_urdf_changes";
}

/** Ask for the kinds of views. */
export interface GetViewKinds {
  request?: number;
  document?: string;
  id?: string;
  type: "get_view_kinds";
}

/** Ask what the opened folders hold; `changed` of the subject `workspaces` says when anew. */
export interface GetWorkspaces {
  request?: number;
  document?: string;
  id?: string;
  type: "get_workspaces";
}

/** Give control to a person who is there. */
export interface GiveControl {
  request?: number;
  document?: string;
  id?: string;
  type: "give_control";
  person: string;
}

/** Show what comes now; a bag is closed. */
export interface GoLive {
  request?: number;
  document?: string;
  id?: string;
  type: "go_live";
}

/** A goal as its server reports it. */
export interface GoalStatusView {
  goal_id: string;
  state: string;
  stamp_s: number;
  is_ours: boolean;
}

/** Answer to `get_goal_statuses`, the newest first. */
export interface GoalStatuses {
  type: "goal_statuses";
  request: number;
  name: string;
  goals: GoalStatusView[];
}

/** A goal, and how far it is. */
export interface GoalView {
  operation: number;
  name: string;
  action_type: string;
  text: string;
  state: "sending" | "accepted" | "executing" | "canceling" | "succeeded" | "canceled" | "aborted" | "rejected" | "failed";
  goal_id: string;
  began_s: number;
  took_s: number;
  feedback_count: number;
  feedback: FeedbackView[];
  result: string;
  trouble: string;
  servers: string[];
  server_said: LogLine | null;
}

/** Goals, the oldest first; all that are kept, or those that changed. */
export interface Goals {
  type: "goals";
  whole: boolean;
  operations: GoalView[];
}

/** The document was closed. */
export interface Gone {
  type: "gone";
  document: string;
}

/** Answer to `get_graph`. */
export interface GraphAnswer {
  type: "graph";
  request: number;
  version: number;
  nodes: GraphNodeView[];
  links: GraphLinkView[];
  other_count: number;
  more: number;
}

/** A topic, a service or an action between nodes. */
export interface GraphLinkView {
  kind: "topic" | "service" | "action";
  name: string;
  types: string[];
  sources: number[];
  targets: number[];
  hidden: boolean;
}

/** The nodes of one name. */
export interface GraphNodeView {
  name: string;
  count: number;
  own: boolean;
  bridge: string;
}

/** Hand a copy in as it is now; handed in again, it takes the place of the one before. */
export interface HandIn {
  request?: number;
  document?: string;
  id?: string;
  type: "hand_in";
}

/** First on every control lane: who you are here. */
export interface Hello {
  type: "hello";
  role: "presenter" | "helper" | "student" | "guest";
  version: string;
  session: string;
}

/** The undo list, newest last, and what is unsaved. */
export interface History {
  type: "history";
  undo: string[];
  redo: string[];
  unsaved_files: string[];
  unsaved_count: number;
}

/** An argument or text that two states do not have alike; None: it is not passed. */
export interface InputDifference {
  kind: SiteKind;
  name: string;
  file: string;
  line: number;
  one: string | null;
  other: string | null;
}

/** Kind of an input in its file. */
export type InputKind = "property" | "arg" | "parameter" | "param_default" | "yaml";

/**
 * Do something to an interactive marker; its server gets the feedback that RViz would send.
 *
 * A drag is a press, moves and a release. Whoever pressed holds the marker: others are refused
 * until the release, or until nothing came for two seconds.
 */
export interface InteractWithMarker {
  request?: number;
  document?: string;
  id?: string;
  type: "interact_with_marker";
  display: string;
  marker: number;
  control?: number | null;
  action: "press" | "move" | "hold" | "release" | "select";
  position?: [number, number, number] | null;
  orientation?: [number, number, number, number] | null;
  turn_rad?: number;
  mouse_point?: [number, number, number] | null;
  entry?: number;
  clicked?: boolean;
}

/** All interactive markers of a document; sent when what can be done with them changes. */
export interface InteractiveMarkers {
  type: "interactive_markers";
  displays: MarkersOfDisplay[];
}

/** Answer to `get_interface`. */
export interface InterfaceAnswer {
  type: "interface";
  request: number;
  name: string;
  kind: "msg" | "srv" | "action";
  parts: string[];
  messages: MessageView[];
  hash: string;
  text: string;
}

/** A text that defines no type. */
export interface InterfaceFaultView {
  place: string;
  line: number;
  reason: string;
}

/** A message, service or action that the package defines. */
export interface InterfaceFileView {
  name: string;
  kind: string;
  file: string;
  is_generated: boolean;
  fault: string;
  line: number;
}

/** Answer to `add_interfaces`. */
export interface InterfacesAdded {
  type: "interfaces_added";
  request: number;
  types: AddedInterface[];
  faults: InterfaceFaultView[];
}

/** Answer to `list_interfaces`: full names in order. */
export interface InterfacesAnswer {
  type: "interfaces";
  request: number;
  distro: string;
  names: string[];
  own: string[];
  faults: InterfaceFaultView[];
}

/** All that is known of an item. */
export interface ItemDetails {
  display: string;
  key: string;
  facts: FactView[];
  in_fixed: FactView[];
}

/** Items of one display. */
export interface ItemKeys {
  display: string;
  keys: string[];
}

/** An item of a display by its key; without a display it is a link of the document's robot. */
export interface ItemRef {
  display: string;
  key: string;
}

/** An item as it is now. */
export interface ItemView {
  display: string;
  key: string;
  kind: string;
  name: string;
  path: string;
  frame: string;
  stamp: string;
  place: [number, number, number] | null;
  box: number[] | null;
  shape: string;
}

/** Answer to `describe_items`; items that are not named are gone. */
export interface ItemsDescribed {
  type: "items_described";
  request: number;
  fixed: string;
  items: ItemView[];
  details: ItemDetails[];
}

/** Answer to `pick_items`: each item once. */
export interface ItemsPicked {
  type: "items_picked";
  request: number;
  items: ItemRef[];
  left_out: number;
}

/** Positions of all movable joints by name, after a command; streams are binary frames. */
export interface JointPositions {
  type: "joints";
  positions: Record<string, number>;
  animating: boolean;
}

/** One joint as the page shows and drags it; rad or m; `axis` normalised, in the child frame. */
export interface JointView {
  name: string;
  type: "fixed" | "revolute" | "continuous" | "prismatic" | "planar" | "floating";
  parent: string;
  child: string;
  axis: [number, number, number];
  lower: number | null;
  upper: number | null;
  mimic: string;
  multiplier: number;
  file: string;
  line: number;
}

/** A launch file of the package. */
export interface LaunchFileView {
  file: string;
  format: string;
  is_installed: boolean;
}

/** Answer to `plan_launch`. */
export interface LaunchPlan {
  type: "launch_plan";
  request: number;
  plan: Plan;
}

/** Show others what the presenter looks at, or no longer. */
export interface Lead {
  request?: number;
  document?: string;
  id?: string;
  type: "lead";
  leading: boolean;
}

/** Whether others are shown what the presenter looks at. */
export interface Leading {
  type: "leading";
  leading: boolean;
}

/** Files below the served folders that are not open, and have unsaved work of an earlier run. */
export interface LeftWork {
  type: "left_work";
  entries: LeftWorkEntry[];
}

/** Unsaved work on one file; `at` is UTC, as ISO 8601. */
export interface LeftWorkEntry {
  path: string;
  title: string;
  at: string;
}

/** What is wrong with a text, and in which line, counted from 1. */
export interface LessonFault {
  line: number;
  sentence: string;
}

/** Answer to `read_lesson`. */
export interface LessonRead {
  type: "lesson_read";
  request: number;
  faults: LessonFault[];
  steps: StepView[];
}

/** A person and their steps. */
export interface LessonRow {
  person: string;
  name: string;
  here: boolean;
  reads: boolean;
  done_s: (number | null)[];
}

/** How the steps of the opened lesson stand, whenever that changed. */
export interface LessonState {
  type: "lesson_state";
  lesson: string;
  steps: StepView[];
}

/** Answer to `get_lesson_table`. */
export interface LessonTable {
  type: "lesson_table";
  request: number;
  lesson: string;
  steps: StepView[];
  rows: LessonRow[];
}

/** Answer to `get_lesson_text`. */
export interface LessonText {
  type: "lesson_text";
  request: number;
  text: string;
}

/** A lesson; one of the course that has a demo is named as its demo. */
export interface LessonView {
  name: string;
  chapter: string;
  node: string;
  has_keys: boolean;
  own: boolean;
  writable: boolean;
  version: string;
  steps: number;
  done: number;
}

/** Answer to `get_lessons`: in the order in which they are taught, chapter by chapter. */
export interface Lessons {
  type: "lessons";
  request: number;
  lessons: LessonView[];
}

/** Answer to `get_link`: `text` goes behind `#robot=` of the studio's address. */
export interface Link {
  type: "link";
  request: number;
  text: string;
  arguments: number;
  files: string[];
  edits: number;
  bag: string;
  at_s: number;
}

/** Where a page looks from, in the fixed frame, m; `field` is the angle of its picture, rad. */
export interface LinkCamera {
  eye: [number, number, number];
  target: [number, number, number];
  up: [number, number, number];
  flat: boolean;
  field: number;
}

/** How the page that a link is made on shows the robot; what is empty is as it was there. */
export interface LinkLook {
  camera: LinkCamera | null;
  part: string;
  layout: string;
}

/** A link with an inertial; None where no number can be given. */
export interface LinkMassView {
  link: string;
  mass_kg: number;
  centre_m: [number, number, number];
  moments_kg_m2: [number, number, number] | null;
  inertia_kg_m2: [number, number, number, number, number, number];
  visual: VolumeView | null;
  collision: VolumeView | null;
}

/**
 * Answer to `open_link`: go to `/d/<document>`, and show it so.
 *
 * `left_out` lists edits that found no place, and a bag that is not here.
 */
export interface LinkOpened {
  type: "link_opened";
  request: number;
  document: string;
  left_out: string[];
  look: LinkLook;
}

/** One link as the page lists it; the parent joint is in the joints. */
export interface LinkView {
  name: string;
  visuals: number;
  collisions: number;
  mass_kg: number | null;
  meshes: string[];
  file: string;
  line: number;
  macros: string[];
}

/** Ask for the bags that can be opened: those of the folder in which the studio records. */
export interface ListBags {
  request?: number;
  document?: string;
  id?: string;
  type: "list_bags";
}

/** The models that the studio ships. */
export interface ListExamples {
  request?: number;
  document?: string;
  id?: string;
  type: "list_examples";
}

/** Ask for the content of a served folder; an empty path lists the served roots. */
export interface ListFolder {
  request?: number;
  document?: string;
  id?: string;
  type: "list_folder";
  path?: string;
}

/** Ask which types are known. */
export interface ListInterfaces {
  request?: number;
  document?: string;
  id?: string;
  type: "list_interfaces";
}

/** The folders in which something new can be made. */
export interface ListPlaces {
  request?: number;
  document?: string;
  id?: string;
  type: "list_places";
}

/** The files that were opened last. */
export interface ListRecent {
  request?: number;
  document?: string;
  id?: string;
  type: "list_recent";
}

/** Ask for the `.rviz` files of the robot's packages, and those opened lately. */
export interface ListRvizFiles {
  request?: number;
  document?: string;
  id?: string;
  type: "list_rviz_files";
}

/** Ask for the topics that have a publisher or a subscription. */
export interface ListTopics {
  request?: number;
  document?: string;
  id?: string;
  type: "list_topics";
}

/** QoS that a display asks for; None: as fits the publishers of its topic. */
export interface ListeningView {
  reliable: boolean | null;
  latched: boolean | null;
  depth: number | null;
}

/** All displays of a document, in order, and the frame they are drawn in. */
export interface LiveDisplays {
  type: "live_displays";
  displays: DisplayView[];
  groups_off: string[];
  fixed_frame: string;
  paused: boolean;
  background: string;
  frame_rate: number;
  kinds: number;
}

/** Set what a parameter file has for a node, one parameter after another. */
export interface LoadParameters {
  request?: number;
  document?: string;
  id?: string;
  type: "load_parameters";
  node: string;
  text: string;
}

/** Answer to `get_log`: the oldest lines after that one, and how many there are in all. */
export interface LogAnswer {
  type: "log";
  request: number;
  connected: boolean;
  lines: LogLine[];
  first: number;
  last: number;
}

/** One line that a node logged. */
export interface LogLine {
  number: number;
  stamp_s: number;
  level: number;
  node: string;
  text: string;
  file: string;
  function: string;
  line: number;
}

/** Ask for the meaning at a place: its value in the run, and where it is defined. */
export interface LookUp {
  request?: number;
  document?: string;
  id?: string;
  file: string;
  offset: number;
  type: "look_up";
}

/** Play one part again and again; both None: the whole, once. */
export interface LoopTime {
  request?: number;
  document?: string;
  id?: string;
  type: "loop_time";
  begin_s?: number | null;
  end_s?: number | null;
}

/** Something of a file that is only kept, and written back as it is. */
export interface LossView {
  reason: "no_display" | "no_property" | "no_value" | "no_tool" | "no_view" | "no_panel" | "no_option" | "empty_group" | "window";
  what: string;
  names: string[];
}

/** Take down the hand of a person; of everybody, if none is named. */
export interface LowerHand {
  request?: number;
  document?: string;
  id?: string;
  type: "lower_hand";
  person?: string;
}

/** One macro call on the way to a place: its name and where it was called. */
export interface MacroCall {
  macro: string;
  called_at: Place;
}

/** A managed node. */
export interface ManagedNodeView {
  name: string;
  state_id: number;
  state: string;
  transitions: TransitionView[];
  trouble: string;
}

/** Answer to `get_managed`. */
export interface ManagedNodes {
  type: "managed_nodes";
  request: number;
  nodes: ManagedNodeView[];
  more: number;
}

/** An interactive marker; where it is, the 3D view knows. */
export interface MarkerView {
  number: number;
  name: string;
  description: string;
  scale: number;
  controls: ControlView[];
  menu: MenuItemView[];
}

/** The interactive markers of one display. */
export interface MarkersOfDisplay {
  display: string;
  visual_aids: boolean;
  markers: MarkerView[];
}

/** Answer to `get_masses`, true of the robot now: ask again when something was built. */
export interface Masses {
  type: "masses";
  request: number;
  links: LinkMassView[];
}

/** The meaning of a name; [start, end) is the name. */
export interface Meaning {
  kind: SubjectKind;
  name: string;
  start: number;
  end: number;
  text: string;
  values: string[];
  unit: string;
  doc: string;
  places: TextPlace[];
  target: string;
  parameters: Parameter[];
  calls: number;
  expression: string;
  expression_values: string[];
}

/** Answer to `look_up`; None: nothing known is there. */
export interface MeaningAnswer {
  type: "meaning";
  request: number;
  meaning: Meaning | null;
}

/** One person of the class. */
export interface MemberView {
  person: string;
  name: string;
  role: "helper" | "student" | "guest";
  here: boolean;
  follows: boolean;
  removed: boolean;
  asks_s: number | null;
  hand_s: number | null;
}

/** One click that may help. */
export interface Mend {
  label: string;
  command: Record<string, boolean | number | string>;
}

/**
 * Make the edits of every error's and every warning's fix as one undo step.
 *
 * Of two that want the same place, the first one's; notes (severity `info`) are left as they are.
 */
export interface MendAll {
  request?: number;
  document?: string;
  id?: string;
  type: "mend_all";
}

/** Make the edit of a finding's fix; the three fields name the finding as in `workspaces`. */
export interface MendPackage {
  request?: number;
  document?: string;
  id?: string;
  type: "mend_package";
  code: string;
  sentence: string;
  label: string;
}

/** An entry of the menu of a marker; its parent is 0 in the menu itself. */
export interface MenuItemView {
  id: number;
  parent: number;
  title: string;
  checked: boolean | null;
}

/** A message, or a part of a call. */
export interface MessageView {
  name: string;
  fields: FieldView[];
  constants: ConstantView[];
  comment: string;
}

/** A publisher and a subscription that do not fit each other, or would not on DDS. */
export interface Misfit {
  publisher: string;
  subscriber: string;
  reasons: string[];
  heard: boolean;
  way: "zenoh" | "bridge" | "dds" | "none";
}

/** Put a saved view before another; empty: at the end. */
export interface MoveView {
  request?: number;
  document?: string;
  id?: string;
  type: "move_view";
  view: string;
  before?: string;
}

/** Your own copies, to all pages of a person. */
export interface MyCopies {
  type: "my_copies";
  copies: CopyView[];
}

/** Answer to `get_my_graph`; what the studio itself has there is left out. */
export interface MyGraph {
  type: "my_graph";
  request: number;
  domain: number;
  nodes: string[];
  topics: OwnTopic[];
  more: number;
}

/** A file that an edit makes, with its whole text; nothing bears that name yet. */
export interface NewFile {
  file: string;
  text: string;
}

/** Make a package `folder/name` out of a template, and open its robot. */
export interface NewRobot {
  request?: number;
  document?: string;
  id?: string;
  type: "new_robot";
  template: "blank" | "rover" | "arm";
  name: string;
  folder?: string;
}

/** Open a text that has no file yet. */
export interface NewUntitled {
  request?: number;
  document?: string;
  id?: string;
  type: "new_untitled";
  text: string;
}

/** Answer to `get_node_access`, to the asker alone. */
export interface NodeAccess {
  type: "node_access";
  request: number;
  domain: number;
  endpoint: string;
  shell: string;
  powershell: string;
}

/** Answer to `get_node`: what it has, grouped as `ros2 node info` does. */
export interface NodeAnswer {
  type: "node";
  request: number;
  name: string;
  count: number;
  subscribers: EndView[];
  publishers: EndView[];
  service_servers: EndView[];
  service_clients: EndView[];
  action_servers: EndView[];
  action_clients: EndView[];
}

/** What a launch file names and does not run here. */
export interface NotStartedView {
  id: number;
  name: string;
  package: string;
  executable: string;
  reason: string;
}

/** A service or an action. */
export interface OfferView {
  name: string;
  types: string[];
  nodes: string[];
}

/** Show a bag in a document; without a document, as one of its own: answered by `opened`. */
export interface OpenBag {
  request?: number;
  document?: string;
  id?: string;
  type: "open_bag";
  path: string;
}

/** Make a copy of a shared document with its unsaved edits, or go on with yours. */
export interface OpenCopy {
  request?: number;
  document?: string;
  id?: string;
  type: "open_copy";
}

/** Open the working copy of a shipped model. */
export interface OpenExample {
  request?: number;
  document?: string;
  id?: string;
  type: "open_example";
  name: string;
  arguments?: Record<string, string>;
}

/** Open a robot whose description comes from a topic, or from a parameter of a node. */
export interface OpenFromWire {
  request?: number;
  document?: string;
  id?: string;
  type: "open_from_wire";
  topic?: string;
  node?: string;
  parameter?: string;
}

/** Receive `lesson_state` of a lesson from now on, about the document that the page shows. */
export interface OpenLesson {
  request?: number;
  document?: string;
  id?: string;
  type: "open_lesson";
  lesson: string;
}

/** Open what a link holds as a document of its own; its edits are unsaved there. */
export interface OpenLink {
  request?: number;
  document?: string;
  id?: string;
  type: "open_link";
  link: string;
}

/** Open a file, package folder, workspace folder or zip below the served roots. */
export interface OpenPath {
  request?: number;
  document?: string;
  id?: string;
  type: "open_path";
  path: string;
  arguments?: Record<string, string>;
}

/** Open a file of that list again, with the arguments that it had. */
export interface OpenRecent {
  request?: number;
  document?: string;
  id?: string;
  type: "open_recent";
  path: string;
}

/** Show what an `.rviz` file says instead of the displays that there are. */
export interface OpenRvizFile {
  request?: number;
  document?: string;
  id?: string;
  type: "open_rviz_file";
  path: string;
}

/** The same with the text of a file that this browser has. */
export interface OpenRvizText {
  request?: number;
  document?: string;
  id?: string;
  type: "open_rviz_text";
  name: string;
  text: string;
}

/** Answer to `open_path`: go to `/d/<document>`. */
export interface Opened {
  type: "opened";
  request: number;
  document: string;
}

/** Answer to `get_origin`, true of the last good run: ask again when something was built. */
export interface Origin {
  type: "origin";
  request: number;
  origin: PartOrigin;
}

/** One attribute of a part, or a text in it, as it came out and as it is written. */
export interface OriginAttribute {
  element: string;
  attribute: string;
  value: string;
  text: string;
  unit: string;
  place: Place;
  site: string;
  inputs: number[];
}

/** One macro call on the way to a part. */
export interface OriginCall {
  macro: string;
  called_at: Place;
  defined_at: Place;
  arguments: number[];
}

/** A condition, a computed include or the like that a part owes its being there to. */
export interface OriginCause {
  tag: string;
  text: string;
  place: Place;
  inputs: number[];
}

/** One value behind a number. `inputs` are those that it was made of itself, as indices. */
export interface OriginInput {
  kind: InputKind;
  name: string;
  text: string;
  value: string;
  place: Place;
  site: string;
  given: boolean;
  inputs: number[];
}

/** Outline of the files of a run; `is_current`: the texts have not changed since. */
export interface Outline {
  files: OutlineFile[];
  macros: OutlineMacro[];
  values: OutlineValue[];
  is_current: boolean;
}

/** Answer to `get_outline`. */
export interface OutlineAnswer {
  type: "outline";
  request: number;
  outline: Outline;
}

/** A file of the run. `inside`: number of the file that brings it in, -1 for the entry. */
export interface OutlineFile {
  file: string;
  inside: number;
  place: TextPlace | null;
  namespace: string;
  is_yaml: boolean;
}

/** A macro of the files of the run; `name` with its namespace. */
export interface OutlineMacro {
  name: string;
  parameters: Parameter[];
  place: TextPlace;
  doc: string;
  calls: number;
  called_at: TextPlace[];
}

/** A property or arg of the files of the run. */
export interface OutlineValue {
  kind: SubjectKind;
  name: string;
  place: TextPlace;
  text: string;
  values: string[];
  doc: string;
}

/** A line that a process printed, or that the launch itself has to say. */
export interface OutputLine {
  number: number;
  process: number;
  stream: "stdout" | "stderr" | "info" | "warn" | "error";
  text: string;
}

/** A topic of a student's domain. */
export interface OwnTopic {
  name: string;
  types: string[];
  publishers: number;
  subscriptions: number;
}

/** Answer to `create_package`, `add_to_package` and `mend_package`. */
export interface PackageEdited {
  type: "package_edited";
  request: number;
  edit: number;
  label: string;
  opened: string;
  files: string[];
  by_hand: string[];
}

/** A package as its source shows it. */
export interface PackageView {
  name: string;
  folder: string;
  path: string;
  build_type: string;
  version: string;
  description: string;
  licenses: string[];
  maintainers: string[];
  dependencies: DependencyView[];
  executables: ExecutableView[];
  interfaces: InterfaceFileView[];
  launch_files: LaunchFileView[];
  robots: RobotFileView[];
  rviz_configs: string[];
  parameter_files: ParameterFileView[];
  readme: string | null;
  is_nested: boolean;
  fault: string;
  is_complete: boolean;
  may_run: boolean;
}

/** A parameter of a macro. */
export interface Parameter {
  name: string;
  kind: string;
  default: string | null;
  forwards: boolean;
}

/** Answer to `dump_parameters`. */
export interface ParameterDump {
  type: "parameter_dump";
  request: number;
  node: string;
  text: string;
}

/** A YAML file with parameters of nodes. */
export interface ParameterFileView {
  file: string;
  nodes: string[];
}

/** Answer to `get_parameter_nodes`: full names, in order. */
export interface ParameterNodes {
  type: "parameter_nodes";
  request: number;
  nodes: string[];
}

/** A parameter that a node did not set, and why. */
export interface ParameterRefusal {
  name: string;
  reason: string;
}

/** A parameter and its descriptor. */
export interface ParameterView {
  name: string;
  value_type: string;
  value: string;
  description: string;
  read_only: boolean;
  constraints: string;
  low: number | null;
  high: number | null;
  step: number;
}

/** Answer to `get_parameters`, in the order of the alphabet. */
export interface Parameters {
  type: "parameters";
  request: number;
  node: string;
  parameters: ParameterView[];
}

/** Parameters of a node that is followed have new values. */
export interface ParametersChanged {
  type: "parameters_changed";
  node: string;
  parameters: ParameterView[];
  gone: string[];
}

/** Answer to `load_parameters`. */
export interface ParametersLoaded {
  type: "parameters_loaded";
  request: number;
  node: string;
  count: number;
  refused: ParameterRefusal[];
}

/** The effect of a text on one part. */
export interface PartEffect {
  part: string;
  aspects: Aspect[];
}

/** Where a part comes from. All indices are into `inputs`; each is there once. */
export interface PartOrigin {
  part: string;
  place: Place;
  include_chain: Place[];
  calls: OriginCall[];
  causes: OriginCause[];
  attributes: OriginAttribute[];
  inputs: OriginInput[];
  is_cut: boolean;
}

/** Let nobody in until it is started again: who takes part is kept. */
export interface PauseClass {
  request?: number;
  document?: string;
  id?: string;
  type: "pause_class";
}

/** Pause drawing, or go on; messages are received meanwhile, and drawn when it goes on. */
export interface PauseScene {
  request?: number;
  document?: string;
  id?: string;
  type: "pause_scene";
  paused: boolean;
}

/** Ask what the items are that were pointed at. */
export interface PickItems {
  request?: number;
  document?: string;
  id?: string;
  type: "pick_items";
  nodes: PickedNode[];
}

/** A node of a display in the 3D view, and which of its parts were pointed at. */
export interface PickedNode {
  display: string;
  path: string;
  shape: string;
  node: string;
  rows: number[];
  place: [number, number, number] | null;
}

/** A place in a source file; `line` and `column` are 1-based, 0 when not known. */
export interface Place {
  file: string;
  line: number;
  column: number;
}

/** Answer to `list_places`: the data folder's own first. */
export interface Places {
  type: "places";
  request: number;
  folders: string[];
}

/** All that a launch file would do with the given arguments. */
export interface Plan {
  file: string;
  package: string;
  arguments: PlannedArgument[];
  nodes: PlannedNode[];
  processes: PlannedProcess[];
  includes: PlannedInclude[];
  happenings: PlannedHappening[];
  settings: PlannedSetting[];
  log: PlannedLog[];
  robots: PlannedRobot[];
  unsupported: PlannedGap[];
  failures: PlannedFailure[];
  unknown: string[];
  ended: string;
}

/** Ask what a launch file would start; a later one of the same person ends this one. */
export interface PlanLaunch {
  request?: number;
  document?: string;
  id?: string;
  type: "plan_launch";
  file: string;
  arguments?: Record<string, string>;
}

/** An argument that a launch file declares. */
export interface PlannedArgument {
  name: string;
  default: string | null;
  choices: string[];
  description: string;
  value: string | null;
  given: boolean;
  where: Where;
  include: number | null;
  condition: PlannedCondition | null;
}

/** What a thing depends on; `holds` is None where a value that it needs is not known. */
export interface PlannedCondition {
  text: string;
  holds: boolean | null;
}

/** What went wrong, in a sentence; the plan holds what could be known all the same. */
export interface PlannedFailure {
  sentence: string;
  where: Where;
}

/** A name that the studio does not know, or does not do; the plan goes on without it. */
export interface PlannedGap {
  name: string;
  sentence: string;
  where: Where;
}

/** What is done later; what it starts has the same `when`. */
export interface PlannedHappening {
  kind: string;
  when: string;
  does: string[];
  condition: PlannedCondition | null;
  include: number | null;
  where: Where;
}

/** A launch file within another; `parent` is None right in the file that was asked for. */
export interface PlannedInclude {
  id: number;
  file: string;
  arguments: Record<string, string>;
  parent: number | null;
  condition: PlannedCondition | null;
  when: string;
  where: Where;
  failed: string;
}

/** A line that the launch file logs. */
export interface PlannedLog {
  text: string;
  condition: PlannedCondition | null;
  when: string;
  where: Where;
}

/** A node that would run. */
export interface PlannedNode {
  id: number;
  kind: string;
  package: string;
  executable: string;
  name: string;
  namespace: string;
  full_name: string;
  parameters: PlannedParameter[];
  files: string[];
  remaps: PlannedRemap[];
  arguments: string[];
  ros_arguments: string[];
  environment: Record<string, string>;
  output: string;
  respawn: boolean;
  respawn_delay_s: number;
  container: string;
  condition: PlannedCondition | null;
  when: string;
  include: number | null;
  where: Where;
  start: PlannedStart;
  prefix: string[];
  cwd: string;
}

/** A parameter that a node is given. */
export interface PlannedParameter {
  name: string;
  value: boolean | number | string | (boolean | number | string | null)[] | null;
  file: string;
  robot: number | null;
}

/** A command that would run; `shell`: by a shell, as one line. */
export interface PlannedProcess {
  id: number;
  command: string[];
  name: string;
  shell: boolean;
  cwd: string;
  environment: Record<string, string>;
  output: string;
  respawn: boolean;
  respawn_delay_s: number;
  condition: PlannedCondition | null;
  when: string;
  include: number | null;
  where: Where;
  start: PlannedStart;
}

/** A name that a node uses, and the one that it gets. */
export interface PlannedRemap {
  source: string;
  target: string;
}

/**
 * A robot description that a node is given: the file and the arguments that xacro would get.
 *
 * `kind` is `xacro` or `urdf`; `node` is the id of the first node that gets it, if one does.
 */
export interface PlannedRobot {
  file: string;
  kind: string;
  mappings: Record<string, string>;
  node: number | null;
  where: Where;
}

/** A variable of the environment that is set; `value` None: unset. */
export interface PlannedSetting {
  name: string;
  value: string | null;
  condition: PlannedCondition | null;
  where: Where;
}

/** How the studio would start a thing, or why it does not. */
export interface PlannedStart {
  kind: string;
  text: string;
}

/** Let the time go on from where it is, or stop it. */
export interface PlayTime {
  request?: number;
  document?: string;
  id?: string;
  type: "play_time";
  playing: boolean;
}

/** One named pose as the page lists it. */
export interface PoseView {
  key: string;
  name: string;
  group: string;
  kind: "own" | "srdf" | "initial";
  file: string;
  line: number;
  positions: Record<string, number>;
  unknown: string[];
  unknown_count: number;
  beyond: string[];
}

/** All named poses that fit the robot. */
export interface Poses {
  type: "poses";
  poses: PoseView[];
  path: string;
  only_here: string;
  trouble: string;
}

/** Press a key of a demo that is driven by keys. */
export interface PressKey {
  request?: number;
  document?: string;
  id?: string;
  type: "press_key";
  demo: string;
  pressed: "up" | "down" | "left" | "right" | "g" | "t" | "r" | "e" | "d" | "c" | "v" | "b" | "f" | "q";
}

/**
 * One finding. `sentence` stands alone; `code` is stable, kebab-case, for tests and tools.
 *
 * `include_chain` runs from the opened file down to (not including) `place`; `macro_stack` from
 * the outermost call to the innermost. `parts` are the parts of the robot to show, by part key:
 * `link:<name>`, `joint:<name>`.
 */
export interface Problem {
  severity: Severity;
  code: string;
  sentence: string;
  place: Place | null;
  include_chain: Place[];
  macro_stack: MacroCall[];
  fix: Fix | null;
  parts: string[];
}

/** All present problems. `showing_last_good`: the view is older than the texts. */
export interface Problems {
  type: "problems";
  problems: Problem[];
  showing_last_good: boolean;
}

/** One process of a run. */
export interface ProcessView {
  id: number;
  name: string;
  node: string;
  state: "running" | "waiting" | "ended";
  code: number;
  starts: number;
  command: string;
}

/** Long work of the document; `total` 0 when not known; done == total ends it. */
export interface Progress {
  type: "progress";
  task: "expand" | "meshes" | "index";
  label: string;
  done: number;
  total: number;
}

/** A property of a kind of display. */
export interface PropertyView {
  name: string;
  kind: "switch" | "whole" | "number" | "colour" | "choice" | "text" | "frame" | "topic" | "fact" | "marker_server";
  default: boolean | number | string;
  doc: string;
  low: number | null;
  high: number | null;
  unit: string;
  choices: string[];
  when: string;
  when_values: (boolean | number | string)[];
}

/** What is or was published. */
export interface PublicationView {
  operation: number;
  name: string;
  message_type: string;
  text: string;
  rate_hz: number;
  reliable: boolean;
  latched: boolean;
  depth: number;
  state: "running" | "done" | "stopped" | "failed";
  sent: number;
  listeners: number;
  began_s: number;
  trouble: string;
}

/** Publications, the oldest first; all that are kept, or those that changed. */
export interface Publications {
  type: "publications";
  whole: boolean;
  operations: PublicationView[];
}

/** Publish a message; those who follow publications receive what becomes of it. */
export interface Publish {
  request?: number;
  document?: string;
  id?: string;
  type: "publish";
  name: string;
  message_type: string;
  text?: string;
  rate_hz?: number;
  reliable?: boolean;
  latched?: boolean;
  depth?: number;
}

/** Publish `/joint_states` as joint_state_publisher does, or stop. */
export interface PublishJoints {
  request?: number;
  document?: string;
  id?: string;
  type: "publish_joints";
  running: boolean;
}

/** Publish `/robot_description` and TF as robot_state_publisher does, or stop. */
export interface PublishRobot {
  request?: number;
  document?: string;
  id?: string;
  type: "publish_robot";
  running: boolean;
}

/** Raise a hand, or take it down. */
export interface RaiseHand {
  request?: number;
  document?: string;
  id?: string;
  type: "raise_hand";
  raised?: boolean;
}

/** Move all joints to random positions within their limits. */
export interface RandomizeJoints {
  request?: number;
  document?: string;
  id?: string;
  type: "randomize_joints";
}

/** Ask what is faulty in the text of a lesson. */
export interface ReadLesson {
  request?: number;
  document?: string;
  id?: string;
  type: "read_lesson";
  text: string;
}

/** Read YAML as values of a type; refused with the field that does not take its value. */
export interface ReadValues {
  request?: number;
  document?: string;
  id?: string;
  type: "read_values";
  name: string;
  place?: number;
  text: string;
}

/** Let a person in again who was sent out. */
export interface ReadmitMember {
  request?: number;
  document?: string;
  id?: string;
  type: "readmit_member";
  person: string;
}

/** Answer to `list_recent` and `forget_recent`: newest first. */
export interface Recent {
  type: "recent";
  request: number;
  files: RecentEntry[];
}

/** One file of the list; `is_there` false: it was removed. */
export interface RecentEntry {
  path: string;
  title: string;
  time_s: number;
  origin: "file" | "example" | "upload" | "untitled";
  is_there: boolean;
}

/** What was recorded of a topic. */
export interface RecordedCount {
  name: string;
  type_name: string;
  count: number;
  lost: number;
}

/** A topic of what is shown. */
export interface RecordedTopicView {
  name: string;
  type_name: string;
  count: number;
  latched: boolean;
  trouble: string;
  note: string;
}

/** The recording of the live system; sent when it changes, and each second while it runs. */
export interface RecordingState {
  type: "recording_state";
  recording: boolean;
  path: string;
  seconds: number;
  messages: number;
  lost: number;
  bytes: number;
  free_bytes: number;
  topics: RecordedCount[];
  trouble: string;
}

/** Do again what was taken back. */
export interface Redo {
  request?: number;
  document?: string;
  id?: string;
  type: "redo";
}

/** A place that names a thing; `line` is its line of text. */
export interface Reference {
  place: TextPlace;
  line: string;
  is_definition: boolean;
  in_run: boolean;
}

/** All places that name a thing, file by file, top to bottom; the first of `count`. */
export interface References {
  kind: SubjectKind | null;
  name: string;
  references: Reference[];
  count: number;
}

/** Answer to `get_references`. */
export interface ReferencesAnswer {
  type: "references";
  request: number;
  references: References;
}

/** The command was not carried out, and why; `kind` is the error's class name. */
export interface Refused {
  type: "refused";
  request: number;
  kind: string;
  reason: string;
}

/** To a page that a relay serves: whether the studio is there, and where else one can go on. */
export interface RelayState {
  type: "relay_state";
  studio: "there" | "away";
  others: string[];
}

/** One relay as the presenter sees it. */
export interface RelayView {
  endpoint: string;
  state: "connecting" | "there" | "lost" | "refused";
  reason: string;
  address: string;
  people: number;
  lag_ms: number;
}

/** The relays of this studio; only to presenters. */
export interface Relays {
  type: "relays";
  relays: RelayView[];
}

/** Read all files of the document from disk again; unsaved edits are given up. */
export interface Reload {
  request?: number;
  document?: string;
  id?: string;
  type: "reload";
}

/** A remark about a display. */
export interface Remark {
  level: "ok" | "warn" | "error";
  reason: string;
  sentence: string;
  mend: Mend | null;
}

/** Remove a display, or a group with all that is in it; `restore_displays` takes it back. */
export interface RemoveDisplay {
  request?: number;
  document?: string;
  id?: string;
  type: "remove_display";
  display?: string;
  group?: string;
}

/** Send a person out; their browser cannot join again until it is let in. */
export interface RemoveMember {
  request?: number;
  document?: string;
  id?: string;
  type: "remove_member";
  person: string;
}

/** Share the class by this relay no more: its people go to another. */
export interface RemoveRelay {
  request?: number;
  document?: string;
  id?: string;
  type: "remove_relay";
  endpoint: string;
}

/** Remove a tool; one Interact tool stays. */
export interface RemoveTool {
  request?: number;
  document?: string;
  id?: string;
  type: "remove_tool";
  tool: string;
}

/**
 * Change the name at a place to `name`, wherever it is used, as one undo step.
 *
 * Refused when the number of places is no longer `count`, the one in `renaming`.
 */
export interface Rename {
  request?: number;
  document?: string;
  id?: string;
  file: string;
  offset: number;
  type: "rename";
  name: string;
  count: number;
}

/** Give one's own pose another name. */
export interface RenamePose {
  request?: number;
  document?: string;
  id?: string;
  type: "rename_pose";
  name: string;
  new_name: string;
}

/** Give a tool another name. */
export interface RenameTool {
  request?: number;
  document?: string;
  id?: string;
  type: "rename_tool";
  tool: string;
  name: string;
}

/** Give a variant another name and note. */
export interface RenameVariant {
  request?: number;
  document?: string;
  id?: string;
  type: "rename_variant";
  name: string;
  new_name: string;
  note?: string;
}

/** Give a saved view another name. */
export interface RenameView {
  request?: number;
  document?: string;
  id?: string;
  type: "rename_view";
  view: string;
  name: string;
}

/** Answer to `get_renaming`: the first of `count` places, in `files` files. */
export interface RenamingAnswer {
  type: "renaming";
  request: number;
  kind: SubjectKind;
  old: string;
  new: string;
  places: FoundText[];
  count: number;
  files: number;
}

/** Make another code and link; those who have joined stay. */
export interface RenewCode {
  request?: number;
  document?: string;
  id?: string;
  type: "renew_code";
}

/**
 * Write `replacement` at all places of a text, as one undo step.
 *
 * Refused when the number of places is no longer `count`, the one in `texts_found`.
 */
export interface ReplaceTexts {
  request?: number;
  document?: string;
  id?: string;
  text: string;
  match_case?: boolean;
  whole_word?: boolean;
  type: "replace_texts";
  replacement: string;
  count: number;
}

/**
 * Replaces the bytes [start, end) of an edited file, which are `before`, by `text`.
 *
 * Both are raw text, escaped as in the file. `before` is never empty: an insertion repeats a text
 * beside it, so that a place that has moved is noticed.
 */
export interface Replacement {
  file: string;
  start: number;
  end: number;
  before: string;
  text: string;
}

/**
 * Forget all messages and transforms received, and begin to count the time anew.
 *
 * All is subscribed again, so that latched messages come once more.
 */
export interface ResetScene {
  request?: number;
  document?: string;
  id?: string;
  type: "reset_scene";
}

/** Put a site back to its text on disk. */
export interface ResetSite {
  request?: number;
  document?: string;
  id?: string;
  type: "reset_site";
  site: string;
}

/**
 * Take a file's changes on disk; where they collide with unsaved edits, one side's.
 *
 * `each` chooses place by place for the first ones, `keep` for those beyond them.
 */
export interface ResolveCollisions {
  request?: number;
  document?: string;
  id?: string;
  type: "resolve_collisions";
  file: string;
  keep: "mine" | "theirs";
  each?: ("mine" | "theirs")[];
  state?: string;
}

/** End one process of a launch and start it again, or start it again once it has ended. */
export interface RestartProcess {
  request?: number;
  document?: string;
  id?: string;
  type: "restart_process";
  run: number;
  process: number;
}

/** Put displays back that were removed, where they stood and as they were set. */
export interface RestoreDisplays {
  request?: number;
  document?: string;
  id?: string;
  type: "restore_displays";
  displays: string[];
}

/** Edits of an earlier run were restored; `at` empty: nothing to report any more. */
export interface Restored {
  type: "restored";
  at: string;
  files: string[];
}

/** Give control back to the presenter. */
export interface ReturnControl {
  request?: number;
  document?: string;
  id?: string;
  type: "return_control";
}

/** A file that is, or might be taken for, a robot description. */
export interface RobotFileView {
  file: string;
  title: string;
  openable: boolean;
  reason: string;
}

/** The robot's tree. `revision` counts structural changes; joint frames carry it. */
export interface RobotState {
  type: "robot";
  revision: number;
  name: string;
  root: string;
  links: LinkView[];
  joints: JointView[];
}

/** Start what runs of a package again whenever a file of that package was saved; or no more. */
export interface RunAgainOnSave {
  request?: number;
  document?: string;
  id?: string;
  type: "run_again_on_save";
  run: number;
  on: boolean;
}

/** Answer to `get_run_output`; when `last` is more than its last line, there is more to ask. */
export interface RunOutput {
  type: "run_output";
  request: number;
  run: number;
  lines: OutputLine[];
  last: number;
  dropped: number;
}

/** Answer to `start_launch` and `start_node`. */
export interface RunStarted {
  type: "run_started";
  request: number;
  run: number;
}

/** A launch file or node that was started out of the page. */
export interface RunView {
  run: number;
  kind: "launch" | "node";
  file: string;
  package: string;
  executable: string;
  arguments: string[];
  line: string;
  state: "starting" | "running" | "stopping" | "ended";
  for_s: number;
  code: number;
  trouble: string;
  again_on_save: boolean;
  again: number;
  processes: ProcessView[];
  not_started: NotStartedView[];
  shown: ShownView[];
}

/** Answer to `get_runs`, the newest first. */
export interface Runs {
  type: "runs";
  request: number;
  runs: RunView[];
}

/** Answer: the file is shown. */
export interface RvizConfigOpened {
  type: "rviz_config_opened";
  request: number;
  name: string;
  displays: number;
  tools: number;
  views: number;
  losses: LossView[];
  view: ViewValues | null;
  page: string;
}

/** The `.rviz` file of a document. */
export interface RvizConfigState {
  type: "rviz_config_state";
  name: string;
  path: string;
  changed: boolean;
  rviz1: boolean;
  undo: boolean;
}

/** An `.rviz` file. */
export interface RvizFileEntry {
  path: string;
  name: string;
  time_s: number | null;
  is_there: boolean;
}

/** Answer: where it was written; or that there is a file already, which is as it was. */
export interface RvizFileSaved {
  type: "rviz_file_saved";
  request: number;
  path: string;
  is_there: boolean;
  changed: boolean;
}

/** Answer: those opened lately, the newest first, then those of the packages. */
export interface RvizFiles {
  type: "rviz_files";
  request: number;
  files: RvizFileEntry[];
  folder: string;
}

/** Answer: the text. */
export interface RvizText {
  type: "rviz_text";
  request: number;
  name: string;
  text: string;
}

/** Answer: what was in use when the file was saved. */
export interface RvizView {
  type: "rviz_view";
  request: number;
  view: ViewValues | null;
  page: string;
}

/** Write the edited bytes of these changed files of the document, or of all. */
export interface Save {
  request?: number;
  document?: string;
  id?: string;
  type: "save";
  files?: string[] | null;
}

/** Write the document's robot to a new place, and go on there. */
export interface SaveAs {
  request?: number;
  document?: string;
  id?: string;
  type: "save_as";
  name: string;
  folder?: string;
  as_package?: boolean;
}

/** Write a file's edited text to a path below the opened folders at which nothing is yet. */
export interface SaveCopy {
  request?: number;
  document?: string;
  id?: string;
  type: "save_copy";
  file: string;
  path: string;
}

/** Write a lesson in the studio's data folder. */
export interface SaveLesson {
  request?: number;
  document?: string;
  id?: string;
  type: "save_lesson";
  lesson: string;
  language?: string;
  text: string;
}

/** Write the last seconds that are kept of the live system into a bag. */
export interface SavePast {
  request?: number;
  document?: string;
  id?: string;
  type: "save_past";
  seconds: number;
  name?: string;
}

/** Keep where the joints are under a name; with `replace` also under one that there is. */
export interface SavePose {
  request?: number;
  document?: string;
  id?: string;
  type: "save_pose";
  name: string;
  replace?: boolean;
}

/** Write an `.rviz` file; without a path the one that was opened. */
export interface SaveRvizFile {
  request?: number;
  document?: string;
  id?: string;
  type: "save_rviz_file";
  path?: string;
  replace?: boolean;
  view?: ViewValues | null;
  page?: string;
  rviz2?: boolean;
}

/** Keep the present arguments and values as a new variant. */
export interface SaveVariant {
  request?: number;
  document?: string;
  id?: string;
  type: "save_variant";
  name: string;
  note?: string;
}

/** Save a view with the document, for all who look at it. */
export interface SaveView {
  request?: number;
  document?: string;
  id?: string;
  type: "save_view";
  kind: string;
  name: string;
  values: Record<string, boolean | number | string>;
  before?: string;
}

/** These files were written. */
export interface Saved {
  type: "saved";
  files: string[];
}

/** A view that is saved with the document. */
export interface SavedView {
  id: string;
  kind: string;
  name: string;
  values: Record<string, boolean | number | string>;
}

/** All views that are saved with a document, in order. */
export interface SavedViews {
  type: "saved_views";
  views: SavedView[];
}

/** A panel was opened in the page, which checks of the page ask about. */
export interface SawPanel {
  request?: number;
  document?: string;
  id?: string;
  type: "saw_panel";
  panel: string;
}

/** Answer to `get_scene_time`; all in seconds, with hundredths that mean something. */
export interface SceneTime {
  type: "scene_time";
  request: number;
  ros_s: number;
  ros_elapsed_s: number;
  wall_s: number;
  wall_elapsed_s: number;
  from_clock: boolean;
  paused: boolean;
}

/**
 * Show another moment; of a live document, one of the last minutes.
 *
 * While a bar is dragged, `settled` is false: what takes longer is left for the last one.
 */
export interface SeekTime {
  request?: number;
  document?: string;
  id?: string;
  type: "seek_time";
  at_s: number;
  settled?: boolean;
}

/** Send a copy back to its owner with a remark. */
export interface SendBack {
  request?: number;
  document?: string;
  id?: string;
  type: "send_back";
  remark: string;
}

/** Send a goal; those who follow goals receive what becomes of it. */
export interface SendGoal {
  request?: number;
  document?: string;
  id?: string;
  type: "send_goal";
  name: string;
  action_type: string;
  text?: string;
  timeout_s?: number;
}

/**
 * Answer to `get_series`: the least and the largest value of each column, in their order.
 *
 * A column without a message has None for both. What is not finite is left out.
 */
export interface Series {
  type: "series";
  request: number;
  first: (number | null)[];
  second: (number | null)[];
  before: [number, number] | null;
  after: [number, number] | null;
  exact: boolean;
  done: number;
  count: number;
  trouble: string;
}

/** Answer to `get_services`. */
export interface Services {
  type: "services";
  request: number;
  services: OfferView[];
}

/** Pass an argument as `name:=value` on the command line would; None takes it back. */
export interface SetArgument {
  request?: number;
  document?: string;
  id?: string;
  type: "set_argument";
  name: string;
  value: string | null;
}

/** Pass several arguments at once, as one run and one undo step; None takes one back. */
export interface SetArguments {
  request?: number;
  document?: string;
  id?: string;
  type: "set_arguments";
  values: Record<string, string | null>;
}

/** Keep these bookmarks, and no others. */
export interface SetBookmarks {
  request?: number;
  document?: string;
  id?: string;
  type: "set_bookmarks";
  bookmarks: Bookmark[];
}

/** Change how others join; what is None stays as it is. */
export interface SetClass {
  request?: number;
  document?: string;
  id?: string;
  type: "set_class";
  locked?: boolean | null;
  password?: string | null;
  join_as?: "student" | "guest" | null;
}

/** Change one setting of a shared display, e.g. `robot`, `collision`, True. */
export interface SetDisplay {
  request?: number;
  document?: string;
  id?: string;
  type: "set_display";
  display: "grid" | "robot" | "ghost";
  name: string;
  value: boolean | number | string;
}

/** Change a property of a display, by RViz's name. */
export interface SetDisplayProperty {
  request?: number;
  document?: string;
  id?: string;
  type: "set_display_property";
  display: string;
  name: string;
  value: boolean | number | string;
}

/** Subscribe to another topic or with another QoS; None chooses by the topic's publishers. */
export interface SetDisplayTopic {
  request?: number;
  document?: string;
  id?: string;
  type: "set_display_topic";
  display: string;
  topic: string;
  reliable?: boolean | null;
  latched?: boolean | null;
  depth?: number | null;
}

/** Draw everything in this frame; empty: in that of the robot's root link. */
export interface SetFixedFrame {
  request?: number;
  document?: string;
  id?: string;
  type: "set_fixed_frame";
  frame: string;
}

/** Choose who moves the joints. */
export interface SetJointSource {
  request?: number;
  document?: string;
  id?: string;
  type: "set_joint_source";
  source: "sliders" | "animation" | "joint_states" | "tf";
}

/** Move joints: positions by name, rad or m; clamped to the limits, mimics follow. */
export interface SetJoints {
  request?: number;
  document?: string;
  id?: string;
  type: "set_joints";
  positions: Record<string, number>;
}

/** Make a person a helper, a student or a guest. */
export interface SetMemberRole {
  request?: number;
  document?: string;
  id?: string;
  type: "set_member_role";
  person: string;
  role: "helper" | "student" | "guest";
}

/** Change your own name. */
export interface SetName {
  request?: number;
  document?: string;
  id?: string;
  type: "set_name";
  name: string;
}

/** Set a parameter of a node; refused with the node's reason when it does not. */
export interface SetParameter {
  request?: number;
  document?: string;
  id?: string;
  type: "set_parameter";
  node: string;
  name: string;
  text: string;
  value_type?: string;
}

/** Let the time go faster or slower. */
export interface SetTimeRate {
  request?: number;
  document?: string;
  id?: string;
  type: "set_time_rate";
  rate: number;
}

/** Change a property of a tool, by RViz's name. */
export interface SetToolProperty {
  request?: number;
  document?: string;
  id?: string;
  type: "set_tool_property";
  tool: string;
  name: string;
  value: boolean | number | string;
}

/** Change what all views of the document have in common; what is None stays. */
export interface SetViewOptions {
  request?: number;
  document?: string;
  id?: string;
  type: "set_view_options";
  background?: string | null;
  frame_rate?: number | null;
}

/**
 * How serious a Problem is.
 *
 * An error keeps the last good model, or ROS rejects the robot for it; a warning does neither, and
 * something will not work as it is written; the rest is worth knowing.
 */
export type Severity = "error" | "warning" | "info";

/** Let everybody see a copy, and bring those who follow to it; or no longer. */
export interface ShowCopy {
  request?: number;
  document?: string;
  id?: string;
  type: "show_copy";
  shown?: boolean;
}

/** What the presenter has selected, points at and has open. */
export interface ShowFocus {
  request?: number;
  document?: string;
  id?: string;
  type: "show_focus";
  part?: string;
  site?: string;
  panel?: string;
}

/**
 * Where the presenter's camera and pointer are; they go to who follows as a binary frame.
 *
 * The frame is the byte 2, a byte that is 1 without perspective, six bytes of nothing, and
 * thirteen little-endian float32: the camera's eye, what it looks at, the pointer, which is NaN
 * where there is none, where the top of the picture points, and the angle that it sees.
 */
export interface ShowView {
  request?: number;
  document?: string;
  id?: string;
  type: "show_view";
  eye: [number, number, number];
  target: [number, number, number];
  pointer?: [number, number, number] | null;
  up?: [number, number, number];
  flat?: boolean;
  field?: number;
}

/** What the page is to show of a launch: `rviz2` with the file of its `-d`. */
export interface ShownView {
  id: number;
  what: string;
  config: string;
}

/** A state to compare: the present robot, the one on disk, or a variant. */
export interface Side {
  kind: "present" | "saved" | "variant";
  name: string;
}

/** Kind of an editable text in its file. */
export type SiteKind = "arg" | "property" | "yaml" | "param_default" | "literal";

/** One editable text, as a property row shows it. */
export interface SiteView {
  id: string;
  kind: SiteKind;
  name: string;
  file: string;
  line: number;
  text: string;
  saved_text: string | null;
  value: string;
  number: number | null;
  values: string[];
  reads: number;
  widget: Widget;
  group: string;
  owner: string;
  argument: string | null;
}

/** The changed sites, and the order of all when it changed (sites not in it are gone). */
export interface Sites {
  type: "sites";
  order: string[] | null;
  changed: SiteView[];
}

/** Topics of which a bridge passes on so many messages a second at most. */
export interface SlowedTopics {
  topics: string;
  rate_hz: number;
}

/** Let others join; a class that was paused goes on. */
export interface StartClass {
  request?: number;
  document?: string;
  id?: string;
  type: "start_class";
}

/** Start a demo as a process of its own, in the system that the studio is connected with. */
export interface StartDemo {
  request?: number;
  document?: string;
  id?: string;
  type: "start_demo";
  demo: string;
}

/** Run a launch file. */
export interface StartLaunch {
  request?: number;
  document?: string;
  id?: string;
  type: "start_launch";
  file: string;
  arguments?: Record<string, string>;
}

/** Run an executable of a package; `arguments` as behind `ros2 run PACKAGE EXECUTABLE`. */
export interface StartNode {
  request?: number;
  document?: string;
  id?: string;
  type: "start_node";
  package: string;
  executable: string;
  arguments?: string[];
}

/** Let students' own nodes join, each in a ROS domain of its own; makes new credentials. */
export interface StartNodes {
  request?: number;
  document?: string;
  id?: string;
  type: "start_nodes";
}

/** Record topics into a bag, by the words of `ros2 bag record`; without any, all of them. */
export interface StartRecording {
  request?: number;
  document?: string;
  id?: string;
  type: "start_recording";
  topics?: string[];
  regex?: string;
  exclude_regex?: string;
  name?: string;
  storage?: "mcap" | "sqlite3";
  compression?: "none" | "zstd" | "lz4";
  max_bag_bytes?: number;
  max_bag_s?: number;
}

/** Start a run again with the same arguments; one that goes on is ended first. */
export interface StartRunAgain {
  request?: number;
  document?: string;
  id?: string;
  type: "start_run_again";
  run: number;
}

/** Go to the next message of a topic, or to the one before; an empty topic means any. */
export interface StepTime {
  request?: number;
  document?: string;
  id?: string;
  type: "step_time";
  topic?: string;
  forward?: boolean;
}

/** A block of checks of a lesson, in the order of its text. */
export interface StepView {
  id: string;
  heading: string;
  done_s: number | null;
  checks: CheckView[];
}

/** End a demo that was started from a page; done when it has ended. */
export interface StopDemo {
  request?: number;
  document?: string;
  id?: string;
  type: "stop_demo";
  demo: string;
}

/** Let none of them join any more, and end the connections of those that have. */
export interface StopNodes {
  request?: number;
  document?: string;
  id?: string;
  type: "stop_nodes";
}

/** Publish it no more; those of that number, or all. */
export interface StopPublishing {
  request?: number;
  document?: string;
  id?: string;
  type: "stop_publishing";
  operation?: number;
}

/** End the recording; its bag is whole afterwards. */
export interface StopRecording {
  request?: number;
  document?: string;
  id?: string;
  type: "stop_recording";
}

/**
 * Stop all that pages make the robot do: publish zero velocity, cancel goals, end publications.
 *
 * Anybody may who takes part, whoever has control.
 */
export interface StopRobot {
  request?: number;
  document?: string;
  id?: string;
  type: "stop_robot";
}

/** End a run, as Ctrl-C does; answered when it has ended. */
export interface StopRun {
  request?: number;
  document?: string;
  id?: string;
  type: "stop_run";
  run: number;
}

/** Write no further what `save_past` or `cut_bag` asked for; no bag is left of it. */
export interface StopWriting {
  request?: number;
  document?: string;
  id?: string;
  type: "stop_writing";
}

/** Somebody has stopped the robot. */
export interface Stopped {
  type: "stopped";
  name: string;
}

/** Whether students' own nodes may join, and where. */
export interface StudentNodesState {
  type: "student_nodes";
  state: "off" | "starting" | "on" | "failed";
  endpoint: string;
  only_here: boolean;
  given: number;
  limit: number;
  trouble: string;
}

/** Kind of the thing at a place in a text. */
export type SubjectKind = "property" | "arg" | "parameter" | "block" | "macro" | "namespace" | "package" | "file" | "folder" | "yaml" | "function" | "constant" | "variable" | "environment" | "command" | "link" | "joint" | "expression" | "tag" | "element" | "attribute" | "value";

/** What was looked at of one subject, so that "all is well" can be trusted. */
export interface SubjectView {
  subject: "router" | "network" | "domain" | "distribution" | "versions" | "bridges" | "nodes" | "topics" | "types" | "qos" | "services" | "parameters" | "clocks" | "rates" | "stamps" | "frames" | "displays" | "document" | "browser";
  state: "well" | "found" | "not_examined";
  count: number;
  detail: string;
}

/** Show or hide displays: one, a group as a whole, or each one of them. */
export interface SwitchDisplays {
  request?: number;
  document?: string;
  id?: string;
  type: "switch_displays";
  display?: string;
  group?: string;
  enabled: boolean;
}

/** Answer to `examine_system`. */
export interface SystemExamined {
  type: "system_examined";
  request: number;
  listened_s: number;
  listens_s: number;
  is_complete: boolean;
  findings: Finding[];
  more: number;
  subjects: SubjectView[];
}

/** Take control: the presenter back, a helper for themselves. */
export interface TakeControl {
  request?: number;
  document?: string;
  id?: string;
  type: "take_control";
}

/** Who talks to whom, as a small drawing. */
export interface Talk {
  sources: string[];
  name: string;
  targets: string[];
  meets: boolean;
}

/** Answer to `get_text`: the text at a version, as `TextChange` describes texts. */
export interface Text {
  type: "text";
  request: number;
  file: string;
  version: number;
  text: string;
  saved: string | null;
  read_only: string;
}

/**
 * Replace [start, end) of the text before by `text`.
 *
 * The text is as an editor holds it: no byte order mark, every line break one LF. Offsets are
 * UTF-16 code units from 0.
 */
export interface TextChange {
  start: number;
  end: number;
  text: string;
}

/** A stretch of one line of a text; `line` and `column` from 1, `length` in code units. */
export interface TextPlace {
  file: string;
  line: number;
  column: number;
  length: number;
}

/** A text that was asked for changed, by an edit or otherwise; it now has this version. */
export interface TextsChanged {
  type: "texts_changed";
  file: string;
  version: number;
  changes: TextChange[];
  origin: string;
}

/** Answer to `find_texts`: the first of `count` places, in `files` files. */
export interface TextsFound {
  type: "texts_found";
  request: number;
  places: FoundText[];
  count: number;
  files: number;
}

/** Answer to `get_tf`. */
export interface TfFrames {
  type: "tf_frames";
  request: number;
  fixed: string;
  frames: FrameView[];
  more: number;
  refused: string[];
  pose: TfPose | null;
  trouble: string;
}

/** Pose of a frame in another. */
export interface TfPose {
  wxyz: [number, number, number, number];
  xyz: [number, number, number];
  chain: string[];
}

/** Answer to `get_time_marks`: how many messages lie in each part; a gap has none. */
export interface TimeMarks {
  type: "time_marks";
  request: number;
  counts: number[];
}

/**
 * What a document shows, and where it stands; sent whenever that is another.
 *
 * While it plays that is once in a second: a page counts on by itself.
 */
export interface TimeState {
  type: "time_state";
  mode: "live" | "past" | "bag";
  title: string;
  path: string;
  zero_s: number;
  begin_s: number;
  end_s: number;
  now_s: number;
  playing: boolean;
  rate: number;
  loop: [number, number] | null;
  skipping: boolean;
  queue: number;
  progress: number | null;
  troubles: string[];
  kept_bytes: number;
  kept_bytes_max: number;
}

/** One of them. */
export interface TimeTick {
  at_s: number;
  level: "warn" | "error";
  source: string;
  text: string;
}

/** Answer to `get_time_ticks`; `more` were left out, and `done` is the share that was read. */
export interface TimeTicks {
  type: "time_ticks";
  request: number;
  ticks: TimeTick[];
  more: number;
  done: number;
}

/** The topics of what is shown; sent after a `time_state` of another recording. */
export interface TimeTopics {
  type: "time_topics";
  topics: RecordedTopicView[];
}

/** A kind of tool. */
export interface ToolKindView {
  kind: string;
  name: string;
  doc: string;
  icon: string;
  properties: PropertyView[];
}

/** Answer to `get_tool_kinds`, in the order of RViz's toolbar. */
export interface ToolKinds {
  type: "tool_kinds";
  request: number;
  kinds: ToolKindView[];
}

/** Answer to `use_tool`: what was sent where. */
export interface ToolUsed {
  type: "tool_used";
  request: number;
  sent_as: "topic" | "action";
  name: string;
  frame: string;
  xyz: [number, number, number];
  wxyz: [number, number, number, number];
  subscriptions: number;
  operation: number;
}

/** A tool as it is set. */
export interface ToolView {
  id: string;
  kind: string;
  name: string;
  icon: string;
  key: string;
  publishes: string;
  values: Record<string, boolean | number | string>;
}

/** All tools of a document, in order. */
export interface Tools {
  type: "tools";
  tools: ToolView[];
}

/** A publisher or a subscription. */
export interface TopicEnd {
  node: string;
  own: boolean;
  bridge: string;
  type_name: string;
  reliability: string;
  durability: string;
  history: string;
  depth: number;
  deadline_s: number | null;
  lifespan_s: number | null;
  liveliness: string;
  lease_s: number | null;
  hash: string;
}

/** Answer to `get_topic_ends`. */
export interface TopicEnds {
  type: "topic_ends";
  request: number;
  publishers: TopicEnd[];
  subscribers: TopicEnd[];
  misfits: Misfit[];
}

/** Rate of a topic. */
export interface TopicRate {
  name: string;
  rate_hz: number;
  bytes_per_s: number;
  age_s: number | null;
  state: "waiting" | "live" | "silent" | "latched";
}

/** Answer to `get_topic_rates`: those that somebody publishes, and for which there is room. */
export interface TopicRates {
  type: "topic_rates";
  request: number;
  rates: TopicRate[];
}

/** One topic; the studio's own subscriptions are not counted. */
export interface TopicRow {
  name: string;
  types: string[];
  publishers: number;
  subscribers: number;
  kind: string;
}

/** Answer to `list_topics`. */
export interface TopicTable {
  type: "topic_table";
  request: number;
  topics: TopicRow[];
}

/** A topic that has a publisher. */
export interface TopicView {
  name: string;
  types: string[];
  publishers: number;
  kind: string;
  kinds: string[];
}

/** Answer to `get_topics`. */
export interface Topics {
  type: "topics";
  request: number;
  topics: TopicView[];
}

/** A transition that a node can be asked for. */
export interface TransitionView {
  id: number;
  label: string;
  goal: string;
}

/** Take back the last step. */
export interface Undo {
  request?: number;
  document?: string;
  id?: string;
  type: "undo";
}

/** Take the newest edit of packages back, if nobody has changed its files since. */
export interface UndoPackageEdit {
  request?: number;
  document?: string;
  id?: string;
  type: "undo_package_edit";
  edit: number;
}

/** Show what was shown before an `.rviz` file was opened; until something else is changed. */
export interface UndoRvizConfig {
  request?: number;
  document?: string;
  id?: string;
  type: "undo_rviz_config";
}

/** Undo, or redo, until this many steps are done; refused when the list is no longer `of`. */
export interface UndoTo {
  request?: number;
  document?: string;
  id?: string;
  type: "undo_to";
  position: number;
  of: number;
}

/** Keep the present arguments and values in a variant that there is. */
export interface UpdateVariant {
  request?: number;
  document?: string;
  id?: string;
  type: "update_variant";
  name: string;
}

/** Answer to `get_urdf`. */
export interface Urdf {
  type: "urdf";
  request: number;
  text: string;
}

/** Answer to `get_urdf_changes`: stretches of lines with a few around each. */
export interface UrdfChanges {
  type: "urdf_changes";
  request: number;
  added: number;
  removed: number;
  hunks: DiffLineView[][];
  left_out: number;
  fault: string;
}

/** Publish what was pointed at with a tool, or send it as a goal. */
export interface UseTool {
  request?: number;
  document?: string;
  id?: string;
  type: "use_tool";
  tool: string;
  fixed_frame?: string;
  x: number;
  y: number;
  z?: number;
  yaw?: number;
}

/** Answer to `read_values`: only what the text names; `now` and `auto` stay as they are. */
export interface ValuesRead {
  type: "values_read";
  request: number;
  values: string;
}

/** Answer to `apply_variant`; `left_out` lists what found no place. */
export interface VariantApplied {
  type: "variant_applied";
  request: number;
  left_out: string[];
}

/** Answer to `save_variant` and `update_variant`: what of the robot no variant can hold. */
export interface VariantSaved {
  type: "variant_saved";
  request: number;
  left_out: string[];
}

/** One text that a variant sets; `name` is for display. */
export interface VariantText {
  file: string;
  name: string;
  text: string;
}

/** One variant as the list shows it. */
export interface VariantView {
  name: string;
  note: string;
  arguments: Record<string, string | null>;
  texts: VariantText[];
}

/** All variants. `active` is empty for the robot as in its files. */
export interface Variants {
  type: "variants";
  variants: VariantView[];
  active: string;
  modified: boolean;
  path: string;
  only_here: string;
  trouble: string;
}

/** A kind of view. */
export interface ViewKindView {
  kind: string;
  doc: string;
  properties: PropertyView[];
}

/** Answer to `get_view_kinds`, in RViz's order. */
export interface ViewKinds {
  type: "view_kinds";
  request: number;
  kinds: ViewKindView[];
}

/** A view of the 3D view, by RViz's names. */
export interface ViewValues {
  kind: string;
  name: string;
  values: Record<string, boolean | number | string>;
}

/** Volume of all visuals or all collisions of a link, m3; an upper bound. */
export interface VolumeView {
  volume_m3: number;
  is_exact: boolean;
}

/** Show me this document: its whole state now, then every change. */
export interface Watch {
  request?: number;
  document?: string;
  id?: string;
  type: "watch";
}

/** A line of a launch file, 1-based; 0 where it is not known. */
export interface Where {
  file: string;
  line: number;
}

/** Editing control of a site; `minimum`, `maximum` and `step` are in `unit`, the file's unit. */
export interface Widget {
  kind: WidgetKind;
  minimum: number | null;
  maximum: number | null;
  step: number | null;
  unit: string;
  choices: string[];
  help: string;
  annotated: boolean;
}

/** How a site is edited: `VECTOR` is two or more numbers separated by blanks. */
export type WidgetKind = "slider" | "switch" | "choice" | "vector" | "text";

/** What of a document's robot comes from ROS, and what is published. */
export interface WireFeed {
  type: "wire_feed";
  source: "sliders" | "joint_states" | "tf";
  source_state: "" | "waiting" | "live" | "silent";
  rate_hz: number;
  strangers: string[];
  publishes_robot: boolean;
  publishes_joints: boolean;
  joints_paused: boolean;
  rivals: string[];
  description_from: string;
  trouble: string;
}

/** Answer to `examine_wire`: what there is at a router, and why nodes are not seen. */
export interface WireReport {
  type: "wire_report";
  request: number;
  endpoint: string;
  domain: number;
  distro: string;
  verdict: "fine" | "no_router" | "foreign" | "not_admitted" | "alone" | "other_domain" | "other_distro" | "bridge" | "unseen";
  starts_router: boolean;
  nodes: number;
  domains: DomainView[];
  distros: string[];
  types: string[];
  unseen: number;
  bridges: BridgeView[];
}

/** Answer to `find_wire_robots`: topics with a robot description, the usual one first. */
export interface WireRobots {
  type: "wire_robots";
  request: number;
  topics: string[];
  nodes: string[];
}

/** State of the studio's connection to a ROS 2 system; sent to every page. */
export interface WireState {
  type: "wire_state";
  state: "off" | "connecting" | "connected" | "lost" | "failed";
  router: "" | "own" | "joined";
  endpoint: string;
  domain: number;
  distro: string;
  nodes: string[];
  node_count: number;
  behind: Record<string, string>;
  bridges: BridgeView[];
  nearby_count: number;
  trouble: string;
}

/** All packages below a folder. */
export interface WorkspaceView {
  root: string;
  packages: PackageView[];
  graph: DependencyGraphView;
  left_out: string[];
  problems: Problem[];
}

/** Answer to `get_workspaces`. */
export interface Workspaces {
  type: "workspaces";
  request: number;
  run_folders: string[];
  workspaces: WorkspaceView[];
  is_reading: boolean;
}

/** Who you are in the class, and what you have asked for. */
export interface You {
  type: "you";
  person: string;
  name: string;
  role: "presenter" | "helper" | "student" | "guest";
  has_control: boolean;
  asking: boolean;
  hand: boolean;
}

/** Move all joints to zero, or to the nearest position within their limits. */
export interface ZeroJoints {
  request?: number;
  document?: string;
  id?: string;
  type: "zero_joints";
}

export type Command =
  | AddDisplay
  | AddInterfaces
  | AddRelay
  | AddToPackage
  | AddTool
  | AnimateJoints
  | ApplyFix
  | ApplyPose
  | ApplyVariant
  | ArrangeDisplay
  | ArrangeGroup
  | AskControl
  | CallService
  | CancelCall
  | CancelGoal
  | CancelPlan
  | ChangeState
  | ChoosePackage
  | CloseDocument
  | CloseLesson
  | CloseRvizConfig
  | CompareVariants
  | Complete
  | ConnectWire
  | CreatePackage
  | CutBag
  | DeleteLesson
  | DeletePose
  | DeleteVariant
  | DeleteView
  | DescribeItems
  | DiscardCopy
  | DiscardRestored
  | DisconnectWire
  | Drive
  | DumpParameters
  | DuplicateDisplay
  | EditSite
  | EditText
  | EndClass
  | EndProcess
  | ExamineSystem
  | ExamineWire
  | FindTexts
  | FindWireRobots
  | Follow
  | FollowChanges
  | FollowFrame
  | FollowOperations
  | FollowParameters
  | ForgetRecent
  | ForgetRun
  | ForgetRvizFile
  | ForgetWork
  | GatherAll
  | GetActions
  | GetArguments
  | GetChanges
  | GetCollisions
  | GetDemoCode
  | GetDemoOutput
  | GetDemos
  | GetDiagnostics
  | GetDisplayKinds
  | GetDoctorReport
  | GetEffects
  | GetFrames
  | GetGoalStatuses
  | GetGraph
  | GetInterface
  | GetLessonTable
  | GetLessonText
  | GetLessons
  | GetLink
  | GetLog
  | GetManaged
  | GetMasses
  | GetMyGraph
  | GetNode
  | GetNodeAccess
  | GetOrigin
  | GetOutline
  | GetParameterNodes
  | GetParameters
  | GetReferences
  | GetRenaming
  | GetRunOutput
  | GetRuns
  | GetRvizText
  | GetRvizView
  | GetSceneTime
  | GetSeries
  | GetServices
  | GetText
  | GetTf
  | GetTimeMarks
  | GetTimeTicks
  | GetToolKinds
  | GetTopicEnds
  | GetTopicRates
  | GetTopics
  | GetUrdf
  | GetUrdfChanges
  | GetViewKinds
  | GetWorkspaces
  | GiveControl
  | GoLive
  | HandIn
  | InteractWithMarker
  | Lead
  | ListBags
  | ListExamples
  | ListFolder
  | ListInterfaces
  | ListPlaces
  | ListRecent
  | ListRvizFiles
  | ListTopics
  | LoadParameters
  | LookUp
  | LoopTime
  | LowerHand
  | MendAll
  | MendPackage
  | MoveView
  | NewRobot
  | NewUntitled
  | OpenBag
  | OpenCopy
  | OpenExample
  | OpenFromWire
  | OpenLesson
  | OpenLink
  | OpenPath
  | OpenRecent
  | OpenRvizFile
  | OpenRvizText
  | PauseClass
  | PauseScene
  | PickItems
  | PlanLaunch
  | PlayTime
  | PressKey
  | Publish
  | PublishJoints
  | PublishRobot
  | RaiseHand
  | RandomizeJoints
  | ReadLesson
  | ReadValues
  | ReadmitMember
  | Redo
  | Reload
  | RemoveDisplay
  | RemoveMember
  | RemoveRelay
  | RemoveTool
  | Rename
  | RenamePose
  | RenameTool
  | RenameVariant
  | RenameView
  | RenewCode
  | ReplaceTexts
  | ResetScene
  | ResetSite
  | ResolveCollisions
  | RestartProcess
  | RestoreDisplays
  | ReturnControl
  | RunAgainOnSave
  | Save
  | SaveAs
  | SaveCopy
  | SaveLesson
  | SavePast
  | SavePose
  | SaveRvizFile
  | SaveVariant
  | SaveView
  | SawPanel
  | SeekTime
  | SendBack
  | SendGoal
  | SetArgument
  | SetArguments
  | SetBookmarks
  | SetClass
  | SetDisplay
  | SetDisplayProperty
  | SetDisplayTopic
  | SetFixedFrame
  | SetJointSource
  | SetJoints
  | SetMemberRole
  | SetName
  | SetParameter
  | SetTimeRate
  | SetToolProperty
  | SetViewOptions
  | ShowCopy
  | ShowFocus
  | ShowView
  | StartClass
  | StartDemo
  | StartLaunch
  | StartNode
  | StartNodes
  | StartRecording
  | StartRunAgain
  | StepTime
  | StopDemo
  | StopNodes
  | StopPublishing
  | StopRecording
  | StopRobot
  | StopRun
  | StopWriting
  | SwitchDisplays
  | TakeControl
  | Undo
  | UndoPackageEdit
  | UndoRvizConfig
  | UndoTo
  | UpdateVariant
  | UseTool
  | Watch
  | ZeroJoints;

export type Event =
  | Actions
  | Arguments
  | BagOpening
  | BagWriting
  | BagWritten
  | Bags
  | Begun
  | Bookmarks
  | Built
  | Calls
  | Changed
  | Changes
  | ClassState
  | Collisions
  | Comparison
  | CompletionsAnswer
  | Control
  | Copies
  | DemoCode
  | DemoOutput
  | Demos
  | DiagnosticsAnswer
  | DiskMerged
  | DisplayKinds
  | DisplayStates
  | Displays
  | DoctorReport
  | DocumentState
  | Documents
  | Done
  | Effects
  | Examples
  | Focus
  | Folder
  | FrameFollowed
  | Frames
  | Gather
  | GoalStatuses
  | Goals
  | Gone
  | GraphAnswer
  | Hello
  | History
  | InteractiveMarkers
  | InterfaceAnswer
  | InterfacesAnswer
  | InterfacesAdded
  | ItemsDescribed
  | ItemsPicked
  | JointPositions
  | LaunchPlan
  | Leading
  | LeftWork
  | LessonRead
  | LessonState
  | LessonTable
  | LessonText
  | Lessons
  | Link
  | LinkOpened
  | LiveDisplays
  | LogAnswer
  | ManagedNodes
  | Masses
  | MeaningAnswer
  | MyCopies
  | MyGraph
  | NodeAnswer
  | NodeAccess
  | Opened
  | Origin
  | OutlineAnswer
  | PackageEdited
  | ParameterDump
  | ParameterNodes
  | Parameters
  | ParametersChanged
  | ParametersLoaded
  | Places
  | Poses
  | Problems
  | Progress
  | Publications
  | Recent
  | RecordingState
  | ReferencesAnswer
  | Refused
  | RelayState
  | Relays
  | RenamingAnswer
  | Restored
  | RobotState
  | RunOutput
  | RunStarted
  | Runs
  | RvizConfigOpened
  | RvizConfigState
  | RvizFileSaved
  | RvizFiles
  | RvizText
  | RvizView
  | Saved
  | SavedViews
  | SceneTime
  | Series
  | Services
  | Sites
  | Stopped
  | StudentNodesState
  | SystemExamined
  | Text
  | TextsChanged
  | TextsFound
  | TfFrames
  | TimeMarks
  | TimeState
  | TimeTicks
  | TimeTopics
  | ToolKinds
  | ToolUsed
  | Tools
  | TopicEnds
  | TopicRates
  | TopicTable
  | Topics
  | Urdf
  | UrdfChanges
  | ValuesRead
  | VariantApplied
  | VariantSaved
  | Variants
  | ViewKinds
  | WireFeed
  | WireReport
  | WireRobots
  | WireState
  | Workspaces
  | You;
