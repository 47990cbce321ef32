"""The cookies by which a browser is known again: a presenter's, a guest's, a member's."""

from __future__ import annotations

from string import ascii_letters, digits
from typing import TYPE_CHECKING, Final, Literal, Protocol

from studio.protocol.roles import Role, Visitor

if TYPE_CHECKING:
    from starlette.datastructures import Headers
    from starlette.responses import Response

    from studio.protocol.roles import HasControl, Person
    from studio.server.credentials import Credentials
    from studio.server.front import Caller, Front

_MEMBER: Final = "member"
_JOINING: Final = "joining"
_MEMBER_LIFE_S: Final = 180 * 24 * 3600
"""A browser may be closed meanwhile; `End class` makes it worthless at once."""
_JOINING_LIFE_S: Final = 600
_JOINING_MAX: Final = 64
_CODE_LETTERS: Final = frozenset(ascii_letters + digits + "-_")
_HEADER_MAX: Final = 8 << 10
"""Browsers send less to one host; of more nothing is read."""


class KnowsMembers(Protocol):
    """The class."""

    @property
    def control(self) -> HasControl:
        """Who has control."""
        ...

    def member_of_cookie(self, given: str, /) -> Person | None:
        """Return who comes with this cookie, while the class is open to them."""
        ...

    def is_sent_out(self, given: str, /) -> bool:
        """Whether this is the cookie of somebody who was sent out."""
        ...


class Cookies:
    """Gives and reads cookies; each kind has a name of its own, so that none replaces another.

    Args:
        credentials: Proofs of presenters and guests.
        classroom: Knows members.
        front: Where the page is.
        takes_passes: Whether a member's cookie may come in an address, as a pass of another relay.
    """

    def __init__(
        self,
        credentials: Credentials,
        classroom: KnowsMembers,
        front: Front,
        *,
        takes_passes: bool = False,
    ) -> None:
        self._credentials, self._classroom, self._front = credentials, classroom, front
        self.takes_passes = takes_passes

    def visitor(self, headers: Headers, caller: Caller) -> Person | None:
        """Return who comes with these cookies: of several roles, the one that may most.

        Who was sent out of the class is nobody, and no guest either.
        """
        jar = cookies(headers)
        if presenter := self._visitor(jar.get(self._name(caller, Role.PRESENTER.value))):
            return presenter
        given = jar.get(self._name(caller, _MEMBER), "")
        if given and (member := self._classroom.member_of_cookie(given)):
            return member
        if given and self._classroom.is_sent_out(given):
            return None
        return self._visitor(jar.get(self._name(caller, Role.GUEST.value)))

    def of_role(self, role: Role) -> Visitor:
        """Return the visitor who proved this role by a token: one person for all with the same."""
        return Visitor(role, f"token-{role.value}", self._classroom.control)

    def is_sent_out(self, headers: Headers, caller: Caller) -> bool:
        """Whether this browser is somebody's who was sent out of the class."""
        return self._classroom.is_sent_out(self.member_cookie(headers, caller))

    def member_of_pass(self, given: str) -> Person | None:
        """Return who comes with this pass; None: it is none, or none is taken here."""
        return self._classroom.member_of_cookie(given) if self.takes_passes and given else None

    def _visitor(self, given: str | None) -> Visitor | None:
        found = self._credentials.visitor_of_cookie(given) if given else None
        return found and Visitor(found.role, found.person, self._classroom.control)

    def give(self, response: Response, caller: Caller, role: Role) -> None:
        """Make a new person of this role of the browser."""
        self._set(response, caller, role.value, self._credentials.cookie_of(role))

    def give_member(self, response: Response, caller: Caller, value: str) -> None:
        """Make the browser a member's; a link from a chat or a course page finds them, too."""
        self._set(response, caller, _MEMBER, value, site="lax", life_s=_MEMBER_LIFE_S)
        response.delete_cookie(self._name(caller, _JOINING), path=self._path())

    def member_cookie(self, headers: Headers, caller: Caller) -> str:
        """Return the member's cookie as it came, valid or not."""
        return cookies(headers).get(self._name(caller, _MEMBER), "")

    def keep_code(self, response: Response, caller: Caller, code: str) -> None:
        """Keep the code of a link for the form, so that the address need not show it."""
        kept = "".join(one for one in code[:_JOINING_MAX] if one in _CODE_LETTERS)
        self._set(response, caller, _JOINING, kept, site="lax", life_s=_JOINING_LIFE_S)

    def code(self, headers: Headers, caller: Caller) -> str:
        """Return the code of the link by which the browser came."""
        return cookies(headers).get(self._name(caller, _JOINING), "")[:_JOINING_MAX]

    def _set(
        self,
        response: Response,
        caller: Caller,
        kind: str,
        value: str,
        *,
        site: Literal["lax", "strict"] = "strict",
        life_s: int | None = None,
    ) -> None:
        response.set_cookie(
            self._name(caller, kind),
            value,
            max_age=life_s,
            path=self._path(),
            secure=caller.is_secure,
            httponly=True,
            samesite=site,
        )

    def _path(self) -> str:
        return self._front.base or "/"

    def _name(self, caller: Caller, kind: str) -> str:
        """Return a name with the port that the browser uses, for all ports of a host share cookies.

        Each kind has its own: a link to join does not replace the presenter's cookie, not even
        when it comes from another site, without the cookie.
        """
        name = f"studio-{caller.host.port or self._front.port}"
        return name if kind == Role.PRESENTER.value else f"{name}-{kind}"


def cookies(headers: Headers) -> dict[str, str]:
    """Return all cookies, of which ours are plain; those of other programs may be of any form."""
    header = headers.get("cookie", "")
    if len(header) > _HEADER_MAX:
        return {}
    pairs = (part.strip().partition("=") for part in header.split(";"))
    return {name: value.strip('"') for name, _, value in pairs}
