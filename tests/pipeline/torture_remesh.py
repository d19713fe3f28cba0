"""Single runs of strake remesh that are killed, starved, or have no place for their result: suites of
torture.py."""

import random
import resource
import subprocess
import time

from torture_support import PATIENCE_SECONDS, SEED, check, mount


class Remesh:
    """strake remesh in a folder with a result from before, which must survive all that goes wrong."""

    COMMAND = ["remesh", "torus.ply", "-o", "out/quads.obj", "--vertices", "400"]
    BEFORE = b"from before\n"

    def __init__(self, programs, folder):
        self.strake = programs / "strake"
        self.folder = folder
        (folder / "out").mkdir(exist_ok=True)
        self.output = folder / "out/quads.obj"
        subprocess.run([self.strake, "sample", "torus", "-o", folder / "torus.ply", "--faces", "4000"],
                       check=True, stdout=subprocess.DEVNULL)

    def start(self, limits=()):
        def limit():
            for what, most in limits:
                resource.setrlimit(what, (most, most))
        self.output.write_bytes(self.BEFORE)
        return subprocess.Popen([self.strake, *self.COMMAND], cwd=self.folder, preexec_fn=limit,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def check_untouched(self, *what):
        check(self.output.read_bytes() == self.BEFORE, *what, "the result from before is gone")

    def fails(self, limits, codes, *parts):
        """Fails with one of the codes and all parts in its message, and leaves nothing."""
        run = self.start(limits)
        said = run.communicate(timeout=PATIENCE_SECONDS)[1]
        check(run.returncode in codes, limits, run.returncode, said)
        for part in parts:
            check(part in said, limits, "is not told:", said)
        self.check_untouched(limits)
        left = [file.name for file in self.output.parent.iterdir() if file != self.output]
        check(not left, limits, "left", left)


def starved(programs, folder):
    """Files that may not grow, and less and less memory."""
    remesh = Remesh(programs, folder)
    for most in (0, 1, 1000, 8192):
        remesh.fails([(resource.RLIMIT_FSIZE, most)], [3], "File too large")
    megabytes = 1 << 20
    loads = next(most for most in range(20, 1000, 5) if subprocess.run(
        [remesh.strake, "--version"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        preexec_fn=lambda most=most: resource.setrlimit(
            resource.RLIMIT_AS, (most * megabytes, most * megabytes))).returncode == 0)
    ends = 0
    for most in range(loads, 10000, 8):
        run = remesh.start([(resource.RLIMIT_AS, most * megabytes)])
        said = run.communicate(timeout=PATIENCE_SECONDS)[1]
        if run.returncode == 0:
            break
        check(run.returncode == 1 and "out of memory" in said, most, "MB:", run.returncode, said)
        remesh.check_untouched(most, "MB")
        ends += 1
    print(f"{ends} runs were out of memory, from {loads} MB on; {most} MB are enough")
    check(ends > 3, "too few runs were out of memory")


def killed(programs, folder):
    """kill -9 of a program at random moments."""
    remesh = Remesh(programs, folder)
    run = remesh.start()
    begin = time.monotonic()
    run.communicate(timeout=PATIENCE_SECONDS)
    whole = time.monotonic() - begin
    made = remesh.output.read_bytes()
    choice = random.Random(SEED)
    for _ in range(20):
        run = remesh.start()
        time.sleep(choice.uniform(0, 1.2) * whole)
        run.kill()
        run.communicate()
        check(remesh.output.read_bytes() in (remesh.BEFORE, made), "half a result")


def fill(disk):
    with (disk / "filler").open("wb", buffering=0) as file:
        try:
            while file.write(bytes(4096)):
                pass
        except OSError:
            return


def no_place(programs, folder):
    """A program's own result on a full and on a read-only disk."""
    for name, told in (("full", "No space left"), ("read-only", "Read-only file system")):
        disk = folder / f"disk-{name}"
        mount(disk, "size=1m")
        remesh = Remesh(programs, disk)
        remesh.output.write_bytes(remesh.BEFORE)
        if name == "full":
            fill(disk)
        else:
            subprocess.run(["mount", "-o", "remount,ro", str(disk)], check=True)
        done = subprocess.run([remesh.strake, *remesh.COMMAND], cwd=disk, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        check(done.returncode == 3 and told in done.stderr, name, done.returncode, done.stderr)
        remesh.check_untouched(name)
        check(len([*remesh.output.parent.iterdir()]) == 1, name, "something is left")
