"""Who may come in: this machine's own browser, or whoever holds the token."""

from __future__ import annotations

import ipaddress
import secrets
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final
from urllib.parse import urlsplit

LOOPBACK: Final = "127.0.0.1"
TOKEN_BYTES: Final = 24


@dataclass(frozen=True)
class Door:
    """What a request has to bring.

    Attributes:
        token: First part of every path; none on this machine's own address.
    """

    token: str | None

    def path(self, target: str) -> str | None:
        """The path behind the token that a request asks for; None if it does not bring it."""
        path = urlsplit(target).path
        if self.token is None:
            return path
        given, _, rest = path.removeprefix("/").partition("/")
        if not secrets.compare_digest(given.encode(), self.token.encode()):
            return None
        return f"/{rest}"

    def refuses(self, headers: Mapping[str, str]) -> str:
        """Why a request is refused for where it comes from; empty if it is not.

        Without a token, a name that leads here may be a stranger's, whose pages must not give orders: only
        this machine's own names are answered. A page of another origin is refused in any case.
        """
        host, origin = headers.get("Host", ""), headers.get("Origin")
        if self.token is None and not is_loopback(urlsplit(f"//{host}").hostname or ""):
            return "this address is answered under the names localhost and 127.0.0.1 only"
        if origin is not None and urlsplit(origin).netloc != host:
            return "a page of another origin may give no orders here"
        return ""


def door_for(host: str) -> Door:
    """A door for an address that is listened at: with a fresh token, unless only this machine reaches it."""
    return Door(None if is_loopback(host) else secrets.token_urlsafe(TOKEN_BYTES))


def is_loopback(host: str) -> bool:
    """Whether a name or address means this machine and no other."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False
