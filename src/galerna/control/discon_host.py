"""The process in which a Bladed-style library lives: reads measurements, calls, answers.

Run as a script, with nothing but the standard library, so that it starts in a few hundredths of
a second. The library and its memory are alone here: what it prints, where it works, how it
crashes or hangs is no concern of the simulation's process. See ``discon_process`` for the other
end of the pipes.
"""

from __future__ import annotations

import ctypes
import json
import os
import shutil
import signal
import struct
import sys
import threading
import time
from collections.abc import Iterator
from typing import Any, BinaryIO

SWAP_RECORDS = 3300  #: what OpenFAST's extended interface has; the oldest libraries use 165
MESSAGE_LENGTH = 1025  #: characters of avcMSG, with the closing NUL
NAME_LENGTH = 12_601  #: characters of avcOUTNAME: names and units of 300 logged channels
STATUS, STATUS_FINAL = 1, -1  #: record number, and its value in the last call
ANSWER_HEAD = struct.Struct("<iI")  #: aviFAIL or fault, length of the message
HUNG, ORPHANED = 124, 125  #: exit codes of this process
LOADED, NOT_LOADED, NO_SYMBOL = 0, 1, 2  #: how loading went


class Watch:
    """Ends this process where a call lasts too long or the simulation's process is gone.

    A thread, since it must act while the library computes; it can, as ctypes releases the
    interpreter during a call. (Linux' parent-death signal would follow the thread that started
    this process, which may end before the simulation does.)
    """

    def __init__(self, parent: int, timeout: float, temporary: str) -> None:
        self._parent, self._timeout, self._temporary = parent, timeout, temporary
        self._began: float | None = None
        threading.Thread(target=self._run, daemon=True).start()

    def __enter__(self) -> None:
        self._began = time.monotonic()

    def __exit__(self, *_: object) -> None:
        self._began = None

    def _run(self) -> None:
        while True:
            time.sleep(min(0.25, 0.25 * self._timeout))
            began = self._began
            if began is not None and time.monotonic() - began > self._timeout:
                os._exit(HUNG)
            if os.name == "posix" and os.getppid() != self._parent:
                discard(self._temporary)
                os._exit(ORPHANED)


class Library:
    """A DISCON procedure with its five arguments."""

    def __init__(self, setup: dict[str, Any]) -> None:
        self._procedure = getattr(ctypes.CDLL(setup["library"]), setup["procedure"])
        self._procedure.restype = None
        self.swap = (ctypes.c_float * SWAP_RECORDS)()
        self._failure = ctypes.c_int(0)
        self._input = ctypes.create_string_buffer(os.fsencode(setup["input_file"]))
        self._output_name = os.fsencode(setup["output_name"])
        self._output = ctypes.create_string_buffer(NAME_LENGTH)
        self._message = ctypes.create_string_buffer(MESSAGE_LENGTH)
        self._constant = {
            **setup["constant"],
            "49": MESSAGE_LENGTH,
            "50": len(self._input),
            "51": len(self._output_name) + 1,
            "64": NAME_LENGTH,
            "129": SWAP_RECORDS,
        }
        self._put(setup["initial"])

    def call(self) -> tuple[int, bytes]:
        """Call with the records as they stand: aviFAIL, and what the library says."""
        self._put(self._constant)
        self._output.value = self._output_name  # names of logged channels may have replaced it
        self._failure.value, self._message.value = 0, b""
        self._procedure(
            self.swap, ctypes.byref(self._failure), self._input, self._output, self._message
        )
        return self._failure.value, self._message.value.strip()

    def _put(self, values: dict[str, float]) -> None:
        for number, value in values.items():
            self.swap[int(number) - 1] = value


class Pipes:
    """The pipes to the simulation; what the library prints goes to a file instead."""

    def __init__(self, log: str) -> None:
        self._requests: BinaryIO = os.fdopen(os.dup(0), "rb")
        self._answers: BinaryIO = os.fdopen(os.dup(1), "wb", buffering=0)
        empty = os.open(os.devnull, os.O_RDONLY)
        printed = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o666)
        for taken, instead in ((0, empty), (1, printed), (2, printed)):
            os.dup2(instead, taken)

    def rows(self, size: int) -> Iterator[bytes]:
        """Requests of ``size`` bytes, until the other end closes."""
        while len(row := self._requests.read(size)) == size:
            yield row

    def answer(self, code: int, values: bytes, message: bytes) -> None:
        """One write, so that it costs one switch to the other process."""
        self._answers.write(ANSWER_HEAD.pack(code, len(message)) + values + message)


def serve(library: Library, setup: dict[str, Any], pipes: Pipes, watch: Watch) -> None:
    """Answer rows of measured records until there are no more; then call for the last time."""
    told = [number - 1 for number in setup["told"]]
    asked = [number - 1 for number in setup["asked"]]
    row, answer = struct.Struct(f"<{len(told)}f"), struct.Struct(f"<{len(asked)}f")
    swap, status = library.swap, None
    for measured in pipes.rows(row.size):
        for record, value in zip(told, row.unpack(measured), strict=True):
            swap[record] = value
        with watch:
            failure, message = library.call()
        status = round(swap[STATUS - 1])
        pipes.answer(failure, answer.pack(*(swap[record] for record in asked)), message)
    if status is not None and status != STATUS_FINAL:  # the simulation's process is gone
        swap[STATUS - 1] = STATUS_FINAL
        with watch:
            library.call()


def main(text: str) -> None:
    """Load the library that the setup names, say how that went, and serve."""
    setup = json.loads(text)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the simulation closes the pipe, in order
    pipes = Pipes(setup["log"])
    if hasattr(signal, "alarm"):  # loading may run code of the library, and holds the interpreter
        signal.setitimer(signal.ITIMER_REAL, setup["timeout"])
    try:
        library = Library(setup)
    except OSError as error:
        return pipes.answer(NOT_LOADED, b"", str(error).encode())
    except AttributeError as error:
        return pipes.answer(NO_SYMBOL, b"", str(error).encode())
    finally:
        if hasattr(signal, "alarm"):
            signal.setitimer(signal.ITIMER_REAL, 0.0)
    pipes.answer(LOADED, b"", b"")
    temporary = setup["temporary"]
    serve(library, setup, pipes, Watch(setup["parent"], setup["timeout"], temporary))
    discard(temporary)


def discard(folder: str) -> None:
    """Remove a folder that nobody wants, where there is one: the other process may be gone."""
    if folder:
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main(sys.argv[1])
