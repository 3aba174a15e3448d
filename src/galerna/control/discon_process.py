"""This end of the pipes to the process in which a Bladed-style library lives.

A library that crashes, hangs or exits ends its own process; here that is an error that says when
and how. Nothing of it outlives the simulation: the other process ends with the pipe.
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from struct import Struct
from typing import IO

from galerna.control import discon_host
from galerna.errors import ControllerError, InputError

OUTPUT_NAME = "discon.out"  #: ROSCO replaces the ending, and writes discon.RO.dbg
LAST_WORDS = 3  #: lines of what the library printed, in an error
WINDOWS_FAULT = 0x8000_0000  #: exit codes from here on are faults, on Windows
CLOSING_TIME = 5.0  #: s that the last call may take, where a call may take longer


@dataclass(frozen=True)
class LibrarySetup:
    """What the library's process is told once.

    ``told`` and ``asked`` are the numbers of the records that go there and come back in every
    call; ``initial`` records are set before the first one, ``constant`` ones before each.
    ``folder`` is where it works, ``input_file`` a name seen from there (empty: none);
    ``output_folder`` holds what it prints and what it writes beside ``avcOUTNAME``.
    """

    library: Path
    folder: Path
    input_file: str
    told: Sequence[int]
    asked: Sequence[int]
    initial: Mapping[int, float]
    constant: Mapping[int, float]
    output_folder: Path | None = None
    procedure: str = "DISCON"
    timeout: float = 30.0


@dataclass(frozen=True)
class Answer:
    """What came back from a call: aviFAIL, the message, and the records asked for."""

    failure: int
    message: str
    packed: bytes
    values: tuple[float, ...]


class LibraryProcess:
    """A library in a process of its own.

    Raises InputError where it cannot be loaded, and ControllerError where it ends or hangs.
    """

    def __init__(self, setup: LibrarySetup) -> None:
        self._setup, self.name = setup, setup.library.name
        self._values = Struct(f"<{len(setup.asked)}f")
        self._unread = b""
        self.answer_due = False  #: while the library computes, and after an interrupted call
        self._temporary = setup.output_folder is None
        self._folder = Path(
            tempfile.mkdtemp(prefix="galerna-discon-")
            if setup.output_folder is None
            else setup.output_folder.resolve()
        )
        self._folder.mkdir(parents=True, exist_ok=True)
        self._log = self._folder / "library.log"
        self._process = self._start()
        try:
            self._wait_until_loaded()
        except BaseException:
            self.kill()
            raise

    def call(self, row: bytes, time: float) -> Answer:
        """Send the values of the records ``told`` (float32), and wait for the answer."""
        self.answer_due = True
        try:
            self._requests.write(row)
        except OSError:
            raise self._ended(time) from None
        failure, message, packed = self._receive(self._values.size, time)
        self.answer_due = False
        return Answer(failure, message, packed, self._values.unpack(packed))

    def close(self) -> None:
        """Let the library be called for the last time, if there was a first, and end."""
        with suppress(OSError, subprocess.TimeoutExpired):
            self._requests.close()
            self._process.wait(min(self._setup.timeout, CLOSING_TIME))
        self.kill()

    def kill(self) -> None:
        """End the process without a word, and remove what it left."""
        self._process.kill()
        self._process.wait()
        for pipe in (self._requests, self._answers):
            with suppress(OSError):
                pipe.close()
        if self._temporary:
            shutil.rmtree(self._folder, ignore_errors=True)

    @property
    def pid(self) -> int:
        """The process' number."""
        return self._process.pid

    def _start(self) -> subprocess.Popen[bytes]:
        setup = self._setup
        text = json.dumps(
            {
                "library": str(setup.library),
                "procedure": setup.procedure,
                "input_file": setup.input_file,
                "output_name": str(self._folder / OUTPUT_NAME),
                "log": str(self._log),
                "told": list(setup.told),
                "asked": list(setup.asked),
                "initial": setup.initial,
                "constant": setup.constant,
                "timeout": setup.timeout,
                "temporary": str(self._folder) if self._temporary else "",
                "parent": os.getpid(),
            }
        )
        process = subprocess.Popen(
            [sys.executable, "-I", "-S", discon_host.__file__, text],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            bufsize=0,
            cwd=setup.folder,
            start_new_session=True,  # what ends a group of processes leaves time for the last call
        )
        assert process.stdin is not None
        assert process.stdout is not None
        self._requests: IO[bytes] = process.stdin
        self._answers: IO[bytes] = process.stdout
        return process

    def _wait_until_loaded(self) -> None:
        code, said, _ = self._receive(0, None)
        if code != discon_host.LOADED:
            where = f"library {self._setup.library}"
            raise InputError(where, *_why_not_loaded(code, said, self._setup))

    def _receive(self, values: int, time: float | None) -> tuple[int, str, bytes]:
        """The next answer, taken whole: code, message, and ``values`` bytes of records."""
        head = discon_host.ANSWER_HEAD
        self._await(head.size, time)
        code, length = head.unpack_from(self._unread)
        begin, end = head.size + values, head.size + values + length
        self._await(end, time)
        packed, message = self._unread[head.size : begin], self._unread[begin:end]
        self._unread = self._unread[end:]
        return code, message.decode(errors="replace"), packed

    def _await(self, size: int, time: float | None) -> None:
        while len(self._unread) < size:
            more = self._answers.read(65536)
            if not more:
                raise self._ended(time)
            self._unread += more

    def _ended(self, time: float | None) -> ControllerError:
        """How the process ended, in words."""
        code, timeout = self._process.wait(), self._setup.timeout
        alarm = -signal.SIGALRM if hasattr(signal, "SIGALRM") else None
        if code in (discon_host.HUNG, alarm):
            what = f"the library did not return within {timeout:g} s"
            hint = "give it more with timeout_s, or find out what it waits for"
        elif code < 0 or code >= WINDOWS_FAULT:
            cause = signal.strsignal(-code) if code < 0 else f"{code:#x}"
            what = f"the library crashed ({cause})"
            hint = "is it made for this machine, this interface and this input file?"
        else:
            what = f"the library ended its process with exit code {code}"
            hint = "it stopped on its own, often because of its input file"
        words = self.last_words()
        hint = f"{hint}\n  it printed: {words}" if words else hint
        return ControllerError(f"control, library {self.name}", what, hint, time)

    def last_words(self) -> str:
        """The last lines that the library printed."""
        try:
            lines = self._log.read_bytes()[-2000:].decode(errors="replace").split("\n")
        except OSError:
            return ""
        return " / ".join([line.strip() for line in lines if line.strip()][-LAST_WORDS:])


def _why_not_loaded(code: int, said: str, setup: LibrarySetup) -> tuple[str, str]:
    """What is wrong with a library and what to do, from the words of the loader."""
    if code == discon_host.NO_SYMBOL:
        hint = "is it a Bladed-style controller, with its procedures exported?"
        return f"it has no procedure {setup.procedure}", hint
    if "wrong ELF class" in said or "not a valid Win32" in said or "incompatible arch" in said:
        return "it is made for another kind of processor", "a 64-bit build of it is needed"
    if "invalid ELF header" in said or "too short" in said or "not a mach-o" in said:
        return "it is not a shared library of this system", "a .so, .dylib or .dll is needed"
    return f"it cannot be loaded: {said}", "does it need another library that is missing?"
