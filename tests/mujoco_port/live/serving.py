"""`wordarm live` as a user starts it, in a process of its own."""

from __future__ import annotations

import re
import subprocess
import sys
from urllib.error import HTTPError
from urllib.request import Request, urlopen


class Served:
    """The page of a shipped agent, served until the end of a `with` statement.

    Attributes:
        address: What was printed.
    """

    def __init__(self, *options: str) -> None:
        self._options = options

    def __enter__(self) -> Served:
        command = [sys.executable, "-m", "evolution", "live", "best-generaliser", "--port=0", *self._options]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        found = re.fullmatch(r"open (http://\S+/) in a browser; Ctrl-C ends\n", line)
        assert found, line + self.process.communicate(timeout=60)[1]
        self.address = found[1]
        return self

    def __exit__(self, *_: object) -> None:
        self.process.kill()
        self.process.communicate()

    @property
    def socket(self) -> str:
        """The address of the socket."""
        return self.address.replace("http", "ws", 1) + "socket"

    def get(self, address: str | None = None, **headers: str) -> tuple[int, str]:
        """Status and text of an answer."""
        request = Request(address or self.address, headers=headers)
        try:
            with urlopen(request, timeout=60) as answer:
                return answer.status, answer.read().decode(errors="replace")
        except HTTPError as error:
            return error.code, error.read().decode()
