/** The little of viser 1.1.1 and three.js r186 that we lean on; a contract test looks whether it is there. */

export interface Vector3 {
  x: number;
  y: number;
  z: number;
  set(x: number, y: number, z: number): this;
  copy(other: Vector3): this;
  clone(): Vector3;
  add(other: Vector3): this;
  sub(other: Vector3): this;
  addScaledVector(other: Vector3, scale: number): this;
  multiplyScalar(scale: number): this;
  dot(other: Vector3): number;
  cross(other: Vector3): this;
  length(): number;
  distanceTo(other: Vector3): number;
  normalize(): this;
  lerp(other: Vector3, part: number): this;
  applyMatrix4(matrix: Matrix4): this;
  transformDirection(matrix: Matrix4): this;
  setFromMatrixPosition(matrix: Matrix4): this;
  setFromMatrixColumn(matrix: Matrix4, index: number): this;
  project(camera: Camera): this;
  unproject(camera: Camera): this;
}

export interface Quaternion {
  x: number;
  y: number;
  z: number;
  w: number;
  set(x: number, y: number, z: number, w: number): this;
  clone(): Quaternion;
  copy(other: Quaternion): this;
  invert(): this;
  multiply(other: Quaternion): this;
}

export interface Matrix4 {
  elements: number[];
  copy(other: Matrix4): this;
  clone(): Matrix4;
  invert(): this;
  multiply(other: Matrix4): this;
}

export interface Box3 {
  min: Vector3;
  max: Vector3;
  clone(): Box3;
  copy(other: Box3): this;
  makeEmpty(): this;
  isEmpty(): boolean;
  union(other: Box3): this;
  applyMatrix4(matrix: Matrix4): this;
  getCenter(target: Vector3): Vector3;
}

export interface Color {
  r: number;
  g: number;
  b: number;
  set(color: string | number): this;
  clone(): Color;
  copy(other: Color): this;
  lerp(other: Color, part: number): this;
}

export interface Texture {
  magFilter: number;
  needsUpdate: boolean;
}

export interface Shader {
  uniforms: Record<string, { value: unknown }>;
  vertexShader: string;
  fragmentShader: string;
}

export interface Material {
  isShaderMaterial?: boolean;
  isLineMaterial?: boolean;
  /** Of a line: its width is in metres. */
  worldUnits?: boolean;
  vertexColors?: boolean;
  defines?: Record<string, unknown>;
  map?: Texture | null;
  transparent: boolean;
  opacity: number;
  depthTest: boolean;
  depthWrite: boolean;
  needsUpdate: boolean;
  color?: Color;
  emissive?: Color;
  emissiveIntensity: number;
  fragmentShader: string;
  vertexShader: string;
  uniforms: Record<string, { value: unknown }>;
  side: number;
  onBeforeCompile: (shader: Shader) => void;
  /** Materials of the same key and the same settings have one program. */
  customProgramCacheKey: () => string;
  clone(): Material;
  copy(other: Material): this;
  dispose(): void;
  addEventListener(type: "dispose", listener: () => void): void;
}

export interface Geometry {
  attributes?: {
    position?: { count: number; getX(at: number): number; getY(at: number): number; getZ(at: number): number };
  };
  /** Corners of triangles, three after three; null: all places are, in their order. */
  index?: { count: number; getX(at: number): number } | null;
  boundingBox: Box3 | null;
  computeBoundingBox(): void;
}

export interface Hit {
  distance: number;
  point: Vector3;
  object: Object3D;
  /** Its corners by their numbers, and where it faces in the mesh's own axes. */
  face?: { a: number; b: number; c: number; normal: Vector3 } | null;
  /** Which of a mesh that is drawn many times. */
  instanceId?: number;
  /** Which of the triangles. */
  faceIndex?: number | null;
}

export interface Pointing {
  ray: { origin: Vector3; direction: Vector3 };
  near: number;
  far: number;
  camera: Camera;
  params: Record<string, object>;
}

export interface Object3D {
  isMesh?: boolean;
  isInstancedMesh?: boolean;
  isPoints?: boolean;
  /** Of a light that casts shadows. */
  shadow?: { normalBias: number; radius: number };
  intensity: number;
  renderOrder: number;
  visible: boolean;
  clone(withChildren: boolean): Object3D;
  parent: Object3D | null;
  children: Object3D[];
  position: Vector3;
  quaternion: Quaternion;
  scale: Vector3;
  matrixWorld: Matrix4;
  getWorldQuaternion(target: Quaternion): Quaternion;
  updateMatrix(): void;
  geometry?: Geometry;
  material?: Material | Material[];
  raycast(pointing: Pointing, hits: Hit[]): void;
  traverseVisible(visit: (object: Object3D) => void): void;
  traverse(visit: (object: Object3D) => void): void;
  updateWorldMatrix(parents: boolean, children: boolean): void;
}

export interface Camera extends Object3D {
  up: Vector3;
  fov: number;
  aspect: number;
  near: number;
  far: number;
  projectionMatrix: Matrix4;
  projectionMatrixInverse: Matrix4;
  /** Ours: only while a picture without perspective is drawn. */
  isOrthographicCamera?: boolean;
  updateProjectionMatrix(): void;
}

export interface Renderer {
  toneMapping: number;
  toneMappingExposure: number;
  getPixelRatio(): number;
  setPixelRatio(ratio: number): void;
  /** Into an object with a method `copy`. */
  getViewport(into: { copy(of: { x: number; y: number; z: number; w: number }): unknown }): unknown;
  setViewport(x: number, y: number, width: number, height: number): void;
  shadowMap: { autoUpdate: boolean };
  render(scene: Scene, camera: Camera): void;
}

export interface Scene extends Object3D {
  environment: object | null;
  environmentIntensity: number;
  onBeforeRender: (renderer: Renderer) => void;
  onAfterRender: (renderer: Renderer) => void;
}

/** What viser moves its camera with; ours takes its place. */
export interface CameraControl {
  mouseButtons: { left: number; middle: number; right: number; wheel: number };
  touches: { one: number; two: number; three: number };
  constructor: { ACTION: Record<string, number> };
  /** Called before each picture. */
  update(seconds: number): boolean;
  /** By the arrow keys, while they are held, rad. */
  rotate(azimuth: number, polar: number, animate?: boolean): unknown;
  getPosition(target: Vector3): Vector3;
  getTarget(target: Vector3): Vector3;
}

export interface Message {
  type: string;
  name?: string;
  owner?: string;
  visible?: boolean;
  position?: [number, number, number];
  virtual?: boolean;
  enabled?: boolean;
  cast_shadow?: boolean;
  props?: Record<string, unknown>;
  updates?: Record<string, unknown>;
}

export interface NodePose {
  wxyz: [number, number, number, number];
  position: [number, number, number];
  /** `needsUpdate`: the node's object stands there from the next picture on. */
  poseUpdateState: "updated" | "needsUpdate" | "waitForMakeObject";
}

export interface Mutable {
  canvas: HTMLCanvasElement | null;
  scene: Scene | null;
  camera: Camera | null;
  cameraControl: CameraControl | null;
  nodeRefFromName: Record<string, Object3D | undefined>;
  nodePoseData: Record<string, NodePose | undefined>;
  messageQueue: Message[];
  /** Null until the canvas stands. */
  drainMessageQueue: (() => void) | null;
  firstMessageBatch: boolean;
  sendMessage: (message: Message) => void;
  requestRender: () => void;
}

export interface JointView {
  name: string;
  type: "fixed" | "revolute" | "continuous" | "prismatic" | "planar" | "floating";
  parent: string;
  child: string;
  axis: [number, number, number];
  lower: number | null;
  upper: number | null;
  mimic: string;
  multiplier?: number;
}

export interface RobotState {
  root: string;
  links: { name: string }[];
  joints: JointView[];
}

/** A camera, in the root frame of the robot: x forward, z up. */
export interface CameraPose {
  /** Metres. */
  position: readonly [number, number, number];
  target: readonly [number, number, number];
  /** Where the top of the picture points; without: upwards. */
  up?: readonly [number, number, number];
  /** Whether it sees without perspective; without: with it. */
  flat?: boolean;
  /** Its opening angle from below to above, rad; without: as it is. */
  field?: number;
}

declare global {
  interface Window {
    __viserMutable?: Mutable;
    __viserSceneTree?: { getState(): Record<string, { message: Message } | undefined> };
    studio3d?: object;
  }
}
