"""Runs a program and says what it took, by the system's account of that process alone."""

import os
import subprocess
import tempfile
import threading
import time
from dataclasses import dataclass


@dataclass(frozen=True)
class Run:
    code: int  # negative: ended by that signal
    output: str  # both streams
    wall: float  # seconds
    cpu: float  # seconds, user and system, all threads
    peak_mb: float  # largest resident set
    read_mb: float  # by system calls, whether from disk or from the cache; mapped files do not count
    written_mb: float


def run(command, most_seconds=None):
    """Runs a command to its end, or kills it after a time by the clock."""
    with tempfile.TemporaryFile() as said:
        started = time.monotonic()
        process = subprocess.Popen([str(word) for word in command], stdin=subprocess.DEVNULL,
                                   stdout=said, stderr=subprocess.STDOUT)
        limit = threading.Timer(most_seconds, process.kill) if most_seconds else None
        if limit:
            limit.start()
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
        wall = time.monotonic() - started
        moved = moved_megabytes(process.pid)
        _, status, used = os.wait4(process.pid, 0)
        if limit:
            limit.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)  # known now; do not wait again
        said.seek(0)
        return Run(process.returncode, said.read().decode(errors="replace"), wall,
                   used.ru_utime + used.ru_stime, used.ru_maxrss / 1024, *moved)


def moved_megabytes(pid):
    """Megabytes read and written by a process that has ended but was not waited for yet."""
    with open(f"/proc/{pid}/io", encoding="ascii") as file:
        account = dict(line.split(": ") for line in file)
    return tuple(int(account[name]) / 1e6 for name in ("rchar", "wchar"))
