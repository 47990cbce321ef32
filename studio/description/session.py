"""One open description: its texts, its arguments, and what changed since the last good run."""

from __future__ import annotations

import logging
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from studio.description.checks.checks import checked_broken, checked_good
from studio.description.checks.spelling import mend_of
from studio.description.evaluator.evaluation import Evaluation
from studio.description.evaluator.output_tree import (
    OutputElement,
    OutputIndex,
    part_of,
    plain_part,
    plain_parts,
)
from studio.description.evaluator.runs import (
    GoodRun,
    RecoveredRun,
    RunRecord,
    problems_of_text,
    recovered_run,
)
from studio.description.evaluator.source_store import SourceStore
from studio.description.faults import Fault, Refusal, Unsupported, problem_of
from studio.description.language.questions import LANGUAGE_QUERIES
from studio.description.language.service import LanguageService
from studio.description.origins.origin_values import PartOriginQuery, SiteEffectsQuery
from studio.description.origins.origins import Origins
from studio.description.patching.live_run import LiveRun
from studio.description.sites.sites import SiteBuilder
from studio.description.syntax.recovery import RECOVERABLE
from studio.description.syntax.source_tree import SourceElement, SourceText, parse_source
from studio.description.values import (
    PATCH_DIFFERED,
    ArgumentsRequest,
    CheckQuery,
    EditRequest,
    Expansion,
    Failure,
    NoReply,
    OpenRequest,
    ReloadRequest,
    VerifyRequest,
)
from studio.errors import DescriptionError, EditError, ExpansionError
from studio.packages.roots import ServedRoots
from studio.problems import Place, Problem, Severity

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from studio.description.elements import Element
    from studio.description.patching.live_run import Patch
    from studio.description.requests import Query, Reply
    from studio.description.values import ReadPolicy, Site

_NOT_OPEN = "No robot is open in this worker: open it again."
_log = logging.getLogger(__name__)
Answer: TypeAlias = Expansion | Failure
Request: TypeAlias = OpenRequest | EditRequest | ArgumentsRequest | ReloadRequest | VerifyRequest


def verified(
    answer: Expansion | Failure, before: Expansion | None, entry: str
) -> Expansion | Failure:
    """Return a full run's answer: changes only if it corrects anything, with a warning.

    One that only proves the patches right is marked as they are.
    """
    if isinstance(answer, Failure):
        return _unproven(answer, entry)
    found = list(_corrections(answer, before))
    if not found:
        return replace(answer, is_patch=True)
    what = f"{len(found)} of the shown values, the first {found[0]}"
    sentence = f"A quick edit was not what a full run gives; corrected: {what}. Tell us of it."
    _log.error("%s: %s", entry, sentence)
    problem = Problem(Severity.WARNING, PATCH_DIFFERED, sentence, Place(entry))
    return replace(answer, warnings=(*answer.warnings, problem))


def _unproven(failure: Failure, entry: str) -> Failure:
    """Return a failure that patches have hidden: the robot that is shown is none of a full run."""
    sentence = "A quick edit hid this; the robot that is shown is of that edit. Tell us of it."
    _log.error("%s: %s: %s", entry, sentence, failure.problem.sentence)
    problem = replace(failure.problem, sentence=f"{failure.problem.sentence} {sentence}")
    return replace(failure, problem=problem)


def _corrections(answer: Expansion, before: Expansion | None) -> Iterator[str]:
    """Yield the names of what differs in a full run."""
    yield from (part.key for part in answer.changed_parts)
    yield from (site.id for site in answer.changed_sites)
    if answer.part_order is not None:
        yield "the order of parts"
    if answer.site_order is not None:
        yield "the order of texts"
    if before is None:
        return
    for name in ("robot_name", "root_attributes", "files", "include_tree", "warnings"):
        if getattr(answer, name) != getattr(before, name):
            yield name


class Session:
    """Runs one entry file again and again. A failed run leaves the last good one standing."""

    def __init__(self, request: OpenRequest) -> None:
        self._entry = request.entry
        self._arguments = dict(request.arguments)
        self._policy: ReadPolicy = request.policy
        self._store = SourceStore(ServedRoots(map(Path, request.policy.roots)), request.overlay)
        self._site_builder = SiteBuilder(request.known)
        self._parts: dict[str, Element] = {}
        self._sites: dict[str, Site] = {}
        self._good: GoodRun | None = None
        self._origins: Origins | None = None
        """Answers questions about the last good run, once there was one."""
        self._touched: set[str] = set()
        """Files edited or read again since the last full run, whose sites the other side moved."""
        self._answered: Expansion | None = None
        """The last good answer."""
        self._live: LiveRun | None = None
        """The last run, when it was a good one that can be patched."""
        self._fault = ""
        """Code of what the last run failed for; empty when it gave a robot."""
        self._chain_to: Callable[[str], tuple[Place, ...]] = lambda _: ()
        """Returns how a file came to be included in the last good run."""
        self._language = LanguageService(self._store, self._policy, self._entry)

    def answer(self, request: Request) -> Answer:
        """Carry out a request and run.

        A text that was edited stays edited when the run fails: it is the user's.
        """
        live, self._live = self._live, None
        if isinstance(request, VerifyRequest):
            return self._verify(live)
        if live is not None and live.can_patch:
            patch = self._patch(live, request)
            if patch is not None:
                self._live = live
                return self._patched(live, patch)
            self._touched |= live.texts.edited
            if isinstance(request, EditRequest) and live.has_edited:
                return self.run()
        try:
            self._take(request)
        except (EditError, Fault) as error:
            problem = Problem(Severity.ERROR, "edit-refused", str(error), Place(self._entry))
            return Failure(problem, tuple(self._store.asked))
        return self.run()

    def _patch(self, live: LiveRun, request: Request) -> Patch | None:
        match request:
            case EditRequest(edits=edits):
                return live.edit(edits)
            case ArgumentsRequest(arguments=arguments):
                before, self._arguments = self._arguments, dict(arguments)
                return live.set_arguments(before, arguments)
            case _:
                return None

    def _verify(self, live: LiveRun | None) -> Answer:
        """Run in full; what it has otherwise than the patches before is a correction."""
        if live is None:
            return self.run()
        self._sites.update(live.texts.moved(self._sites))
        before = self._answered
        answer = verified(self.run(), before, self._entry)
        if self._live is not None:
            self._live.expect_edits_like(live)
        return answer

    def _patched(self, live: LiveRun, patch: Patch) -> Expansion:
        """Answer what a patch changed."""
        root, record = live.index.root, live.record
        parts = [plain_part(root, live.index.keys[one], one) for one in patch.parts]
        changed = [part for part in parts if self._parts[part.key] != part.element]
        sites = self._site_builder.patch(patch.sites, live.texts.live)
        self._parts.update((part.key, part.element) for part in changed)
        self._sites.update((site.id, site) for site in sites)
        self._keep_good(root, record, "studio")
        self._answered = Expansion(
            robot_name=root.attributes.get("name", ""),
            root_attributes=tuple(root.attributes.items()),
            part_order=None,
            changed_parts=tuple(part_of(part) for part in changed),
            site_order=None,
            changed_sites=sites,
            files=record.files,
            include_tree=record.includes,
            warnings=record.warnings,
            evaluator="studio",
            is_patch=True,
        )
        return self._answered

    def query(self, query: Query) -> Reply:
        """Answer a question from the last good run; nothing changes.

        A question that has no answer, or fails, gets a NoReply with the reason.
        """
        try:
            return self._reply(query)
        except Fault as fault:
            return NoReply(fault.sentence)
        except EditError as error:
            return NoReply(str(error))
        except Exception as error:  # noqa: BLE001 - a question may not cost the process its robot
            return NoReply(f"The question could not be answered: {type(error).__name__}: {error}")

    def _reply(self, query: Query) -> Reply:
        if isinstance(query, CheckQuery):
            return self._check()
        if isinstance(query, LANGUAGE_QUERIES):
            if self._live is not None:
                self._sites.update(self._live.texts.moved(self._sites))
            return self._language.answer(query, self._arguments, self._good, self._sites)
        if self._good is None:
            return NoReply("The description has not been expanded yet: mend its problems first.")
        self._origins = self._origins or Origins(self._good)
        match query:
            case PartOriginQuery(part=part):
                return self._origins.part(part)
            case SiteEffectsQuery(site=site):
                return self._origins.effects(site)

    def _take(self, request: Request) -> None:
        match request:
            case EditRequest(edits=edits):
                self._store.edit(edits)
                self._touched.update(self._store.resolve(edit.file) for edit in edits)
            case ArgumentsRequest(arguments=arguments):
                self._arguments = dict(arguments)
            case ReloadRequest(files=files, overlay=overlay):
                self._touched.update(files, overlay)
                self._store.reload(files, overlay)
            case OpenRequest() | VerifyRequest():
                pass

    def run(self) -> Answer:
        """Expand, and answer what changed against the last good run."""
        self._store.begin_run()
        evaluation = Evaluation(self._store, self._policy, self._arguments)
        reason = ""
        try:
            try:
                root = evaluation.run(self._entry)
            except Unsupported as unknown:
                reason = str(unknown)
                evaluation, root = self._fall_back()
            _check_root(root)
            return self._expansion(evaluation, root, reason)
        except MemoryError:
            fault = Refusal("output-too-large", "The robot comes to more text than can be shown.")
            return self._failed(fault)
        except Fault as fault:
            return self._failed(fault)
        except DescriptionError as error:
            self._fault = "expansion-failed"
            return Failure(_problem_of_error(error, self._entry), tuple(self._store.asked))

    def _check(self) -> Reply:
        """Check the texts as they are, broken or not."""
        if self._fault in RECOVERABLE:
            broken = recovered_run(self._store, self._policy, self._arguments, self._entry)
            return checked_broken(broken)
        if self._fault or self._good is None:
            return NoReply("The description does not expand: mend its problems first.")
        return checked_good(self._good, self._chain_to)

    def _failed(self, fault: Fault) -> Answer:
        """Return all faults; of a first robot with broken texts, return what can be read."""
        self._fault = fault.code
        problem, files = problem_of(fault, self._entry), tuple(self._store.asked)
        if fault.code not in RECOVERABLE or fault.place is None:
            mend = mend_of(fault, self._store.trees(files))
            return Failure(replace(problem, fix=mend or problem.fix), files)
        if self._good is None:
            run = recovered_run(self._store, self._policy, self._arguments, self._entry)
            if run.root is not None and run.problems:
                return self._recovered(run, run.root)
            return Failure(problem, files, run.problems)
        path, data = self._store.read(fault.place.file)
        return Failure(problem, files, problems_of_text(path, data, fault.include_chain))

    def _recovered(self, run: RecoveredRun, root: OutputElement) -> Expansion:
        """Answer the robot that broken texts come to."""
        parts = plain_parts(root)
        part_order, files = tuple(part.key for part in parts), tuple(run.store.asked)
        is_same = self._answered is not None and part_order == tuple(self._parts)
        expansion = Expansion(
            robot_name=root.attributes.get("name", ""),
            root_attributes=tuple(root.attributes.items()),
            part_order=None if is_same else part_order,
            changed_parts=tuple(part_of(p) for p in parts if self._parts.get(p.key) != p.element),
            site_order=None if self._answered else (),
            changed_sites=(),
            files=tuple(dict.fromkeys((*self._store.asked, *files))),
            include_tree=tuple(run.evaluation.includes),
            warnings=run.problems,
            evaluator="studio",
            is_recovered=True,
        )
        self._parts = {part.key: part.element for part in parts}
        self._answered = expansion
        return expansion

    def _fall_back(self) -> tuple[Evaluation, OutputElement]:
        """Let stock xacro expand; its elements all seem to stand at the entry's first line."""
        from studio.description.evaluator.stock_xacro import expand_root  # noqa: PLC0415 - only when needed

        text = expand_root(self._entry, self._arguments, self._policy, self._store)
        origin = self._store.tree(self._entry).root
        tree = parse_source(self._entry, text.encode())
        evaluation = Evaluation(self._store, self._policy, self._arguments)
        return evaluation, _as_output(tree.root, origin)

    def _expansion(self, evaluation: Evaluation, root: OutputElement, reason: str) -> Expansion:
        parts = plain_parts(root)
        index = OutputIndex(root)
        record = self._record(evaluation, index)
        sites = self._site_builder.build(record)
        part_order, site_order = tuple(p.key for p in parts), tuple(s.id for s in sites)
        expansion = Expansion(
            robot_name=root.attributes.get("name", ""),
            root_attributes=tuple(root.attributes.items()),
            part_order=None if self._answered and part_order == tuple(self._parts) else part_order,
            changed_parts=tuple(part_of(p) for p in parts if self._parts.get(p.key) != p.element),
            site_order=None if self._answered and site_order == tuple(self._sites) else site_order,
            changed_sites=tuple(s for s in sites if self._is_new(s)),
            files=record.files,
            include_tree=record.includes,
            warnings=record.warnings,
            evaluator="xacro" if reason else "studio",
            fallback_reason=reason,
        )
        self._touched.clear()
        self._parts = {part.key: part.element for part in parts}
        self._sites = {site.id: site for site in sites}
        self._answered = expansion
        self._keep_good(root, record, expansion.evaluator)
        self._fault, self._chain_to = "", evaluation.chain_to
        if not reason:
            builder = self._site_builder
            self._live = LiveRun(evaluation, record, index, builder.reads, builder.files)
        return expansion

    def _keep_good(self, root: OutputElement, record: RunRecord, evaluator: str) -> None:
        self._good = GoodRun(
            root,
            record,
            evaluator,
            self._entry,
            self._arguments,
            self._policy,
            self._store.kept(self._good.store if self._good else None),
            self._sites.keys(),
        )
        self._origins = None

    def _is_new(self, site: Site) -> bool:
        """Whether a site is sent: it changed, or the other side may have moved it wrongly."""
        before = self._sites.get(site.id)
        return site.place.file in self._touched or (before is not site and before != site)

    def _record(self, evaluation: Evaluation, index: OutputIndex) -> RunRecord:
        files = tuple(self._store.asked)
        return RunRecord(
            entry=self._store.resolve(self._entry),
            trees=self._store.trees(files),
            files=files,
            includes=tuple(evaluation.includes),
            bindings=tuple(evaluation.bindings.values()),
            yaml=evaluation.texts.yaml,
            part_keys=index.keys_by_source(),
            arguments=_values(evaluation),
            warnings=tuple(evaluation.texts.warnings),
        )


def _values(evaluation: Evaluation) -> Mapping[str, str]:
    return {name: one.value for name, one in evaluation.texts.arguments.items()}


def _as_output(element: SourceElement, origin: SourceElement) -> OutputElement:
    made = OutputElement(element.tag, origin, None)
    made.attributes = element.attributes
    for child in element.children:
        if isinstance(child, SourceElement):
            made.children.append(_as_output(child, origin))
        elif isinstance(child, SourceText):
            made.children.append(child)
    return made


def _check_root(root: OutputElement) -> None:
    if root.tag != "robot":
        sentence = f"The root element is <{root.tag}>: a robot description has <robot>."
        fault = Fault("root-not-robot", sentence)
        fault.place = root.origin.place
        raise fault


def _problem_of_error(error: DescriptionError, entry: str) -> Problem:
    if isinstance(error, ExpansionError):
        return error.problem
    return Problem(Severity.ERROR, "expansion-failed", str(error), Place(entry))


def open_session(request: OpenRequest) -> tuple[Session | None, Answer]:
    """Start a session and run it; None when not even its overlay may be taken."""
    try:
        session = Session(request)
    except Refusal as refusal:
        return None, Failure(problem_of(refusal, request.entry), (request.entry,))
    return session, session.run()


class OpenSession:
    """The one session of a process: what is opened next takes its place."""

    def __init__(self) -> None:
        self._session: Session | None = None

    def answer(self, request: Request | Query) -> Answer | Reply:
        """Answer one request; a robot that cannot be expanded is an answer too."""
        if isinstance(request, OpenRequest):
            self._session, answer = open_session(request)
            return answer
        if isinstance(request, Request):
            if self._session is None:
                return Failure(Problem(Severity.ERROR, "no-session", _NOT_OPEN), ())
            return self._session.answer(request)
        return self._session.query(request) if self._session else NoReply(_NOT_OPEN)
