#!/usr/bin/env python3
"""Runs pipelines while everything goes wrong: torture.py SUITE BIN_FOLDER.

Whatever happens, every result that the store claims to have has the bytes of an undisturbed run, no
process is left over, and the next run completes.
"""

import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from torture_remesh import killed, no_place, starved
from torture_support import PATIENCE_SECONDS, SEED, check, mount

PIPELINE = """version: 1
store: {store}
stages: {{import: {{}}, tensor: {{}}, smooth: {{}}, trace: {{}}, mesh: {{}},
         evaluate: {{inputs: {{candidate: quads}}, options: {{samples: 1000}}}}}}
models:
  torus: {{sample: {{kind: torus, faces: 2000}}}}
  sphere: {{sample: {{kind: sphere, faces: 1500}}}}
outputs: {{quads: "out/{{model}}.obj", report: "out/{{model}}.json"}}
"""
MARK = f"STRAKE_TORTURE={os.getpid()}"


class Place:
    """A folder with a pipeline, and its store there or elsewhere."""

    def __init__(self, programs, folder, store=None):
        self.strake = programs / "strake"
        self.folder = folder
        self.store = store or folder / "store"
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "pipeline.yaml").write_text(PIPELINE.format(store=self.store))

    def start(self, *arguments):
        name, value = MARK.split("=")
        return subprocess.Popen([self.strake, *arguments], cwd=self.folder, start_new_session=True,
                                env={**os.environ, name: value}, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def call(self, *arguments):
        """Exit code and all that was said."""
        process = self.start(*arguments)
        out, err = process.communicate(timeout=PATIENCE_SECONDS)
        return process.returncode, out + err

    def must_run(self, *arguments):
        code, said = self.call("run", *arguments)
        check(code == 0, "the run failed:", said)
        return said

    def entries(self):
        """Bytes of the artifacts that the store claims to have, by entry and name."""
        found = {}
        for manifest in self.store.glob("*/*/manifest.json"):
            for file in manifest.parent.iterdir():
                if file.name not in ("manifest.json", "lock") and file.suffix != ".tmp":
                    found[f"{manifest.parent.relative_to(self.store)}/{file.name}"] = \
                        file.read_bytes()
        return found

    def count_finished(self):
        return len([*self.store.glob("*/*/manifest.json")])

    def outputs(self):
        # A kill while an output is copied leaves a hidden file beside it.
        return {file.name: file.read_bytes() for file in (self.folder / "out").iterdir()
                if not file.name.startswith(".")}

    def half_written(self):
        return [str(file) for file in self.store.glob("[!.]*/**/*.tmp")]

    def check_whole(self, reference):
        for name, content in self.entries().items():
            check(reference.get(name) == content, name, "is not what an undisturbed run makes")

    def check_complete(self, reference, outputs):
        said = self.must_run()
        check(self.entries() == reference, "other entries than an undisturbed run makes")
        check(self.outputs() == outputs, "other outputs than an undisturbed run writes")
        code, text = self.call("check", *sorted(str(file) for file in self.store.glob("*/*/*.hdf")))
        check(code == 0, text)
        return said


def processes():
    """Ours that still run: number -> command line."""
    found = {}
    for folder in pathlib.Path("/proc").iterdir():
        if not folder.name.isdigit():
            continue
        try:
            if MARK.encode() not in (folder / "environ").read_bytes().split(b"\0"):
                continue
            state = (folder / "stat").read_text().rsplit(")", 1)[1].split()[0]
            if state != "Z":
                found[int(folder.name)] = (folder / "cmdline").read_bytes().decode().split("\0")
        except (OSError, IndexError):
            continue  # it has just ended
    return found


def kind(words):
    name = os.path.basename(words[0])
    if name == "strake":
        return words[1]
    return "stage" if name.startswith("strake-") else name


def check_nothing_left(what):
    deadline = time.monotonic() + 10
    while left := processes():
        check(time.monotonic() < deadline, what, "left behind", left)
        time.sleep(0.01)


def reference_of(programs, folder):
    """Entries and outputs of an undisturbed run."""
    place = Place(programs, folder / "reference")
    place.must_run()
    entries = place.entries()
    check(len(entries) == 16, entries.keys())
    return entries, place.outputs()


def seconds_of_a_run(programs, folder):
    """On this machine, as it is loaded now."""
    place = Place(programs, folder / "timed")
    begin = time.monotonic()
    place.must_run("--jobs", "2")
    return time.monotonic() - begin


def wait_for_moment(place, run, choice, most, seconds):
    """Until the run has made a random number of results, at most so many, and a random part of the
    seconds has passed: it is hit at work however fast the machine is by now."""
    wanted = place.count_finished() + choice.randint(0, most)
    while run.poll() is None and place.count_finished() < wanted:
        time.sleep(0.005)
    time.sleep(choice.uniform(0, seconds))


def kills(programs, folder):
    """kill -9 at random moments, of the run, Ninja, a step or a stage."""
    reference, outputs = reference_of(programs, folder)
    whole = seconds_of_a_run(programs, folder)
    place = Place(programs, folder / "here")
    choice = random.Random(SEED)
    counts, interrupted, wanted = {}, 0, 40
    for _ in range(wanted):
        run = place.start("run", "--jobs", "2")
        wait_for_moment(place, run, choice, most=4, seconds=whole / 8)
        running = processes()
        kinds = [kind(words) for words in running.values()]
        targets = [target for target in ("run", "ninja", "step", *3 * ("stage",)) if target in kinds]
        if targets:
            target = choice.choice(targets)
            victims = [pid for pid, words in running.items() if kind(words) == target]
            counts[target] = counts.get(target, 0) + 1
            victim = choice.choice(sorted(victims))
            try:
                os.kill(victim, signal.SIGKILL)
            except ProcessLookupError:
                pass
        out, err = run.communicate(timeout=PATIENCE_SECONDS)
        check_nothing_left(f"after a kill of {target}" if targets else "after a run")
        if run.returncode != 0:
            interrupted += "step" in kinds
            check(run.returncode == -signal.SIGKILL or "error" in err or "killed" in err, err)
        place.check_whole(reference)
        if run.returncode == 0 and len(place.entries()) == len(reference):
            check(place.entries() == reference, "a run that succeeded is incomplete")
            shutil.rmtree(place.store)
    print(f"{wanted} rounds, kills: {counts}, of running steps: {interrupted}")
    check(interrupted >= wanted // 3, "too few kills hit running steps:", interrupted)
    check(len(counts) == 4, "not every kind of process was killed:", counts)
    place.check_complete(reference, outputs)
    check(not place.half_written(), place.half_written())


def interrupt_starts(programs, folder):
    """SIGINT to what a run starts as soon as it exists, before it has become another program."""
    for number in range(8):
        run = Place(programs, folder / f"starts{number}").start("run")
        children = pathlib.Path(f"/proc/{run.pid}/task/{run.pid}/children")
        while not (begun := children.read_text().split()):
            check(run.poll() is None, "the run started nothing")
        os.kill(int(begun[0]), signal.SIGINT)
        out, err = run.communicate(timeout=PATIENCE_SECONDS)
        check(run.returncode != 0, "an interruption was swallowed:", out)
        check_nothing_left("after an early interruption")


def interrupts(programs, folder):
    """Ctrl-C, and SIGTERM to the run alone, at random moments."""
    reference, outputs = reference_of(programs, folder)
    whole = seconds_of_a_run(programs, folder)
    choice = random.Random(SEED)
    stopped, slowest = 0, 0.0
    for number in range(16):
        place = Place(programs, folder / f"here{number}")
        run = place.start("run", "--jobs", "2")
        wait_for_moment(place, run, choice, most=13, seconds=whole / 8)
        begin = time.monotonic()
        if number % 2:
            os.kill(run.pid, signal.SIGTERM)
        else:
            os.killpg(run.pid, signal.SIGINT)
        out, err = run.communicate(timeout=PATIENCE_SECONDS)
        slowest = max(slowest, time.monotonic() - begin)
        check_nothing_left("after an interruption")
        if run.returncode == 0:
            continue
        before_handler = run.returncode in (-signal.SIGINT, -signal.SIGTERM)
        check(run.returncode == 130 or before_handler, run.returncode, err)
        stopped += run.returncode == 130
        check(not place.half_written(), place.half_written())
        check(not [*place.folder.glob("out/.*")], "half an output")
        place.check_whole(reference)
        finished = len(place.entries())
        if number % 4 < 2:
            said = place.check_complete(reference, outputs)
            check(f"{finished} in the store" in said, finished, "were finished, but:", said)
    interrupt_starts(programs, folder)
    print(f"{stopped} of 16 interrupted, the slowest after {slowest:.2f} s")
    check(stopped >= 10, "too few were interrupted:", stopped)
    check(slowest < 10 + whole, "an interruption took", slowest, "s, a whole run", whole, "s")


def together(programs, folder):
    """Two and three runs on one store at once, and gc meanwhile."""
    reference, outputs = reference_of(programs, folder)
    for count in (2, 3):
        store = folder / f"shared{count}"
        places = [Place(programs, folder / f"here{count}-{i}", store) for i in range(count)]
        runs = [place.start("run") for place in places]
        ran = 0
        for run, place in zip(runs, places):
            out, err = run.communicate(timeout=PATIENCE_SECONDS)
            check(run.returncode == 0, err)
            ran += out.count("  ran  ")
            check(place.outputs() == outputs, "other outputs")
        check(ran == len(reference), f"{count} runs made {ran} results where {len(reference)} are")
        places[0].check_complete(reference, outputs)
    for number, arguments in enumerate((["--unreachable"], ["--max-size", "0"])):
        place = Place(programs, folder / f"gc{number}")
        run = place.start("run")
        sweeps, seen = 0, 0
        while run.poll() is None:
            # Clearing all the time would let nobody get anywhere; once in a while must do no harm.
            finished = place.count_finished()
            if finished > seen and (arguments[0] == "--unreachable" or sweeps < 2):
                code, said = place.call("gc", *arguments)
                check(code == 0, said)
                sweeps += 1
                seen = place.count_finished()
            time.sleep(0.002)
        out, err = run.communicate()
        check(run.returncode == 0, err)
        check(sweeps > 1, "gc came too late")
        check(place.outputs() == outputs, "other outputs")
        place.check_complete(reference, outputs)
    check_nothing_left("runs at once")


def memory(programs, folder):
    """Steps run one after the other where memory allows only one, and at once where it allows more."""
    most = {}
    for limit in ("100MB", "10GB"):
        place = Place(programs, folder / limit)
        run = place.start("run", "--jobs", "4", "--memory", limit)
        while run.poll() is None:
            stages = sum(kind(words) == "stage" for words in processes().values())
            most[limit] = max(most.get(limit, 0), stages)
        check(run.returncode == 0, run.stderr.read())
    print("stages at once:", most)
    check(most["100MB"] == 1, most)
    check(most["10GB"] >= 2, most)


def processor_seconds(pid):
    """That a process has used so far."""
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def stage_commands(folder):
    """A command of every stage, on what those before it made, and its output."""
    commands = [
        "sample OUT.ply --kind torus --faces 120000", "import sample.ply OUT.hdf", "tensor import.hdf OUT.hdf",
        "tensor-part import.hdf OUT.hdf --part 1 --parts 1", "tensor-merge import.hdf tensor-part.hdf OUT.hdf",
        "smooth import.hdf tensor.hdf OUT.hdf", "trace import.hdf smooth.hdf OUT.hdf --vertices 8000",
        "mesh import.hdf trace.hdf OUT.hdf", "fit import.hdf mesh.hdf OUT.hdf --field smooth.hdf",
        "size import.hdf smooth.hdf trace.hdf fit.hdf OUT.hdf",
        "refine import.hdf fit.hdf OUT.hdf --refine-tolerance 0.03%", "refine-uncross import.hdf fit.hdf OUT.hdf",
        "refine-worst import.hdf fit.hdf OUT.hdf",
        "export fit.hdf OUT.obj",
        "evaluate import.hdf fit.hdf OUT.json --samples 1000000"]
    for command in commands:
        stage, *words = command.split()
        output = folder / next(word for word in words if "OUT" in word).replace("OUT", stage)
        inputs = [str(folder / word) if "." in word and "%" not in word else word
                  for word in words if "OUT" not in word]
        yield stage, [*inputs, "-o", str(output), "--threads", "1", "-q"], output


LOADING_SECONDS = 0.1  # that a program's libraries may take


def cancel(programs, folder):
    """SIGINT at any moment of any stage: it ends with its code within a second of work, and leaves
    nothing."""
    choice = random.Random(SEED)
    slowest = {}
    for stage, words, output in stage_commands(folder):
        command = [programs / f"strake-{stage}", *words]
        run = subprocess.Popen(command, stdout=subprocess.DEVNULL)
        whole = os.wait4(run.pid, 0)[2]
        run.returncode = 0
        check(output.exists(), stage, "did not end")
        made = output.read_bytes()
        whole = whole.ru_utime + whole.ru_stime
        stopped = 0
        for moment in [choice.uniform(0.1, 1) for _ in range(4)]:
            output.unlink()
            run = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            while run.poll() is None and processor_seconds(run.pid) < moment * whole:
                time.sleep(0.002)
            before = processor_seconds(run.pid) if run.poll() is None else 0
            run.send_signal(signal.SIGINT)
            said = run.stderr.read().decode()
            status, used = os.wait4(run.pid, 0)[1:] if run.returncode is None else (0, None)
            run.returncode = run.returncode or os.waitstatus_to_exitcode(status)
            # A program that is still being loaded has not asked for signals yet.
            is_loaded = run.returncode != -signal.SIGINT or before > LOADING_SECONDS
            check(not is_loaded or run.returncode in (0, 130), stage, run.returncode, said)
            check(run.returncode != 0 or output.exists(), stage, "has no output")
            check(not output.exists() or output.read_bytes() == made, stage, "left half an output")
            check(not [*folder.glob(".*")], stage, "left", [*folder.glob(".*")])
            if run.returncode == 130:
                stopped += 1
                after = used.ru_utime + used.ru_stime - before
                slowest[stage] = max(slowest.get(stage, 0), after)
            output.write_bytes(made)
        print(f"{stage}: {whole:.2f} s, {stopped} of 4 interrupted, the slowest after "
              f"{slowest.get(stage, 0):.2f} s of work", flush=True)
    check(len(slowest) >= 9, "hardly a stage was interrupted:", slowest)
    check(max(slowest.values()) < 1, "interruptions that took longer than a second:", slowest)


def disk_full(programs, folder):
    """A disk that is too small for the store, by different amounts."""
    reference, outputs = reference_of(programs, folder)
    total = sum(len(content) for content in reference.values())
    for number, share in enumerate((0.02, 0.15, 0.3, 0.45, 0.6, 0.75, 0.9)):
        disk = folder / f"disk{number}"
        mount(disk, f"size={int(share * total)}")
        place = Place(programs, folder / f"here{number}", disk / "store")
        code, said = place.call("run", "--jobs", "2")
        check(0 < code <= 5, code, said)
        check("No space left" in said or "disk full" in said, said)
        check_nothing_left("a full disk")
        place.check_whole(reference)
        subprocess.run(["mount", "-o", "remount,size=64m", str(disk)], check=True)
        place.check_complete(reference, outputs)
        check(not place.half_written(), place.half_written())


def read_only(programs, folder):
    """A store on a disk that cannot be written."""
    reference, outputs = reference_of(programs, folder)
    disk = folder / "disk"
    mount(disk, "size=64m")
    place = Place(programs, folder / "here", disk / "store")
    place.must_run()
    subprocess.run(["mount", "-o", "remount,ro", str(disk)], check=True)
    shutil.rmtree(place.folder / "out")
    place.check_complete(reference, outputs)
    code, said = place.call("run", "--set", "trace.seed=7")
    check(code == 3 and "Read-only file system" in said and "another store" in said, code, said)
    for arguments in (["status", "--verify"], ["run", "--dry-run", "--set", "trace.seed=7"],
                      ["gc", "--unreachable"]):
        code, said = place.call(*arguments)
        check(code == 0, arguments, said)
    code, said = place.call("gc", "--max-size", "0")
    check(code == 3 and "Read-only file system" in said, code, said)
    check_nothing_left("a read-only store")


SUITES = {suite.__name__: suite
          for suite in (kills, killed, interrupts, cancel, together, memory, starved, disk_full,
                       no_place, read_only)}
NEED_MOUNTS = ("disk_full", "no_place", "read_only")


def main():
    suite, programs = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    if suite in NEED_MOUNTS and "--inside" not in sys.argv:
        # Mounts in a namespace of their own: nobody else sees them, and they end with it.
        unshare = ["unshare", "-m"] if os.geteuid() == 0 else ["unshare", "-rm"]
        sys.exit(subprocess.run([*unshare, sys.executable, *sys.argv, "--inside"]).returncode)
    with tempfile.TemporaryDirectory(prefix="strake-torture-") as folder:
        try:
            SUITES[suite](programs, pathlib.Path(folder).resolve())
        finally:
            for disk in pathlib.Path(folder).glob("disk*"):
                subprocess.run(["umount", "-l", str(disk)], check=False)
    print(f"torture: {suite} survived")


if __name__ == "__main__":
    main()
