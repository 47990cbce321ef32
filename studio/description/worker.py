"""The xacro worker: `python -m studio.description.worker` answers requests on its pipes."""

from __future__ import annotations

from studio.description.requests import CODEC, QUERIES, Query, Reply
from studio.description.session import NOT_OPEN, Answer, Request, Session, open_session
from studio.description.values import Failure, NoReply, OpenRequest
from studio.problems import Problem, Severity
from studio.settings import XACRO_MEMORY_BYTES
from studio.workers import serve


class Desk:
    """Holds the one session of this process."""

    def __init__(self) -> None:
        self._session: Session | None = None

    def handle(self, request: Request | Query) -> Answer | Reply:
        """Answer one request; a robot that cannot be expanded is an answer too."""
        if isinstance(request, QUERIES):
            return self._session.query(request) if self._session else NoReply(NOT_OPEN)
        if isinstance(request, OpenRequest):
            self._session, answer = open_session(request)
            return answer
        if self._session is None:
            return Failure(Problem(Severity.ERROR, "no-session", NOT_OPEN), ())
        return self._session.answer(request)


def main() -> None:
    """Serve until the pipe closes."""
    serve(CODEC, Desk().handle, XACRO_MEMORY_BYTES)


if __name__ == "__main__":
    main()
