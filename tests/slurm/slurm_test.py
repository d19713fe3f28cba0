#!/usr/bin/env python3
"""`strake run --engine slurm` on a private Slurm of three nodes: slurm_test.py BIN.

Six models by three variants. One model is broken, one node dies with its jobs; what does not depend
on them completes, and the same command again makes the rest. In the end all bytes are those of a
local run. BIN is the folder of the programs.
"""

import contextlib
import fcntl
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).parent
BIN = pathlib.Path(sys.argv[1]).resolve()
PATIENCE_SECONDS = 150  # of a machine on which other tests run

BROKEN = "scan"
BROKEN_INDEX = "2"
PIPELINE = """\
version: 1
models:
  part: {sample: {kind: part, faces: 2000}}
  torus: {sample: {kind: torus, faces: 2000}}
  scan: scan.ply
  saddle: {sample: {kind: saddle, faces: 2000}}
  ellipsoid: {sample: {kind: ellipsoid, faces: 2000}}
  cylinder: {sample: {kind: cylinder, faces: 2000}}
stages: {import: , tensor: {resources: {parts: 2}}, smooth: , trace: , mesh: , fit: , evaluate: }
options: {trace: {tolerance: 1%}}
variants: {seed: {trace: {seed: [1, 2, 3]}}}
outputs: {fitted: "out/{model}-{variant}.obj", report: "out/{model}-{variant}.json"}
cluster: {options: [--partition=main, --comment=strake]}
"""


class Failed(Exception):
    pass


def check(condition, message):
    if not condition:
        raise Failed(message)


def call(command, folder, environment, expected=0):
    """Runs a command and returns what it says; its exit code has to be the expected one."""
    done = subprocess.run([str(word) for word in command], cwd=folder, env=environment, text=True,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, timeout=PATIENCE_SECONDS)
    check(done.returncode == expected,
          f"{command} ended with {done.returncode}, not {expected}:\n{done.stdout}")
    return done.stdout


def wait_for(what, condition):
    """Waits until the condition gives something that counts as true, and returns that."""
    deadline = time.monotonic() + PATIENCE_SECONDS
    while time.monotonic() < deadline:
        if result := condition():
            return result
        time.sleep(0.1)
    raise Failed(f"waited {PATIENCE_SECONDS} s in vain: {what}")


@contextlib.contextmanager
def private_slurm(folder):
    """A Slurm that ends with this process, whatever happens to it: its input is a pipe of ours."""
    process = subprocess.Popen([sys.executable, HERE / "private_slurm.py", folder],
                               stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                               start_new_session=True)
    try:
        check(process.stdout.readline().startswith("ready"), "Slurm does not start")
        yield {"SLURM_CONF": f"{folder}/slurm.conf"}
    finally:
        process.stdin.close()
        process.wait()


@contextlib.contextmanager
def held(entry):
    """Keeps an entry of a store from being made: its step waits as for another run."""
    entry.mkdir(parents=True, exist_ok=True)
    with (entry / "lock").open("w") as lock:
        fcntl.lockf(lock, fcntl.LOCK_EX)
        yield


class Step:
    """A process `strake step` that runs on some node."""

    def __init__(self, process):
        self.pid = int(process.name)
        self.words = (process / "cmdline").read_bytes().decode().split("\0")[:-1]
        pairs = (process / "environ").read_bytes().decode().split("\0")
        self.environment = dict(pair.split("=", 1) for pair in pairs if "=" in pair)
        status = (process / "status").read_text()
        self.parent = int(re.search(r"^PPid:\s*(\d+)", status, re.MULTILINE)[1])
        self.id = self.words[3]
        self.node = self.environment.get("SLURMD_NODENAME")

    @property
    def task(self):
        return "{SLURM_ARRAY_JOB_ID}_{SLURM_ARRAY_TASK_ID}".format(**self.environment)


def running_steps(run):
    steps = []
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError, IndexError, ValueError):
            step = Step(process)
            if step.words[1:3] == ["step", str(run)]:
                steps.append(step)
    return steps


def waiting_step(run):
    """The step that waits for a lock this test holds."""
    for progress in (run / "progress").iterdir():
        with contextlib.suppress(OSError):
            if "another run" in progress.read_text():
                return next((s for s in running_steps(run) if s.id == progress.name), None)
    return None


def orders_of(run):
    return {file.stem: json.loads(file.read_text()) for file in (run / "steps").glob("*.json")}


def outcomes_of(run):
    return {file.stem: json.loads(file.read_text())
            for file in (run / "outcomes").glob("*.json")}


def with_followers(ids, orders):
    """The steps, and all that need them, directly or not."""
    followers = set(ids)
    while True:
        more = {name for name, order in orders.items()
                if any(i.get("from") in followers for i in order["inputs"] + order["parts"])}
        if more <= followers:
            return followers
        followers |= more


def runs_in(folder):
    """Folders of all runs, in the order in which they were made."""
    runs = (folder / ".strake/.runs").glob("*/run.json")
    return [run.parent for run in sorted(runs, key=lambda run: run.stat().st_mtime_ns)]


def results_in(folder):
    """Bytes of all artifacts and outputs by path: all that two runs must have in common."""
    files = [f for f in (folder / ".strake").glob("[!.]*/*/*")
             if f.name not in ("lock", "manifest.json")]
    files += (folder / "out").iterdir()
    return {str(file.relative_to(folder)): file.read_bytes() for file in files}


def check_equal_results(folder, reference, models=""):
    def wanted(results):
        return {k: v for k, v in results.items() if re.search(models, k)}
    ours, theirs = wanted(results_in(folder)), wanted(results_in(reference))
    check(theirs, "there is nothing to compare with")
    check(sorted(ours) == sorted(theirs), f"other files: {sorted(set(ours) ^ set(theirs))}")
    different = [name for name in ours if ours[name] != theirs[name]]
    check(not different, f"other bytes: {different}")


class SlurmTest:
    def __init__(self, folder, environment):
        self.folder = folder
        self.environment = {"PATH": "/usr/bin:/bin", "CANARY": "not for jobs", **environment}
        self.strake = BIN / "strake"
        self.put_forward = set()  # tasks

    def call(self, command, folder, expected=0):
        return call(command, folder, self.environment, expected)

    def queue(self, *options):
        command = ["squeue", "--noheader", "--array", *options]
        return self.call(command, self.folder).split("\n")[:-1]

    def pipeline(self, name, broken=False):
        folder = self.folder / name
        folder.mkdir()
        (folder / "pipeline.yaml").write_text(PIPELINE)
        scan = folder / f"{BROKEN}.ply"
        if broken:
            scan.write_text("ply\nformat ascii 1.0\nelement vertex lots\n")
        else:
            self.call([BIN / "strake-sample", "--kind", "sphere", "--faces", "2000", "-o", scan],
                      folder)
        return folder

    def entry_like(self, folder, model, stage):
        """Where a run in `folder` will put what the reference has for this model and stage."""
        return folder / ".strake" / model / next(
            (self.reference / ".strake" / model).glob(f"{stage}-*")).name

    def run(self):
        self.reference = self.pipeline("reference")
        self.call([self.strake, "run", "--jobs", "2", "--quiet"], self.reference)
        self.refusals()
        self.earlier_submissions()
        self.interrupted_and_waited_for()
        self.submitted_run()
        self.scripts_by_hand()

    def refusals(self):
        for words, said in ((["--engine", "slurm", "--jobs", "2"], "--jobs"),
                            (["--engine", "slurm", "--memory", "1GB"], "--memory"),
                            (["--wait"], "--engine slurm"),
                            (["--engine", "slurm", "--set", "trace.seed=9", "--sbatch",
                              "--array=7"], "--array")):
            answer = self.call([self.strake, "run", *words], self.reference, 2)
            check(said in answer, f"{words} is refused with '{answer}'")
        folder = self.pipeline("back\\slash")
        answer = self.call([self.strake, "submit"], folder, 2)
        check("a backslash in its path" in answer, answer)
        check(not runs_in(folder), "a run that is refused has a folder")
        without = call([self.strake, "submit", "--set", "trace.seed=9"], self.reference,
                       {"PATH": "/nonexistent"}, 3)
        check("not installed" in without, f"without Slurm it says '{without}'")
        check(not self.queue(), "what was refused is in the queue")

    def earlier_submissions(self):
        """What waits is cancelled by a submission of all that it is for, and by no other."""
        folder = self.pipeline("targets")
        submit = [self.strake, "submit", "--until", "import"]
        with held(self.entry_like(folder, "part", "sample")):
            self.call([*submit, "part"], folder)
            wait_for("a step at the lock", lambda: waiting_step(runs_in(folder)[0]))
            for other in (["torus"], ["part/seed-1"], ["part", "--set", "import.feature-angle=33"]):
                answer = self.call([*submit, *other], folder)
                check("cancelled" not in answer, f"for {other}: {answer}")
            self.call([self.strake, "submit", "--until", "tensor", "--set", "tensor.radius=2%",
                       "saddle"], folder)
            answer = self.call([*submit, "--set", "tensor.radius=2%", "saddle"], folder)
            check("cancelled" not in answer, f"up to an earlier stage: {answer}")
            before = len(runs_in(folder))
            waiting = subprocess.Popen([*submit, "--wait", "part", "torus"], cwd=folder,
                                       env=self.environment, stdin=subprocess.DEVNULL,
                                       stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            wait_for("the jobs of the last one", lambda: len(runs_in(folder)) > before and self.queue(
                "--states=PENDING", "--name=" + self.job_name(runs_in(folder)[-1], "import")))
            # An interrupt of what submits would take the jobs back.
            wait_for("the end of the submission", lambda: subprocess.run(
                ["pgrep", "-P", str(waiting.pid)], stdout=subprocess.DEVNULL, check=False).returncode)
            waiting.send_signal(signal.SIGINT)
            answer = waiting.communicate(timeout=PATIENCE_SECONDS)[0]
            check(waiting.returncode == 130 and "the jobs go on" in answer, answer)
            check("cancelled" in answer, answer)
            check(self.queue(), "an interrupted --wait takes its jobs back")
        wait_for("an empty queue", lambda: not self.queue())
        answer = self.call([*submit, "part", "torus"], folder)
        check(answer.startswith("0 steps"), f"the jobs did not go on: {answer}")

    def interrupted_and_waited_for(self):
        """What the cluster stops and starts again has not ended."""
        folder = self.pipeline("preempted")
        with held(self.entry_like(folder, "torus", "import")):
            waiting = subprocess.Popen([self.strake, "submit", "--wait", "--until", "import", "torus"],
                                       cwd=folder, env=self.environment, stdin=subprocess.DEVNULL,
                                       stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            run = wait_for("a run", lambda: runs_in(folder))[0]
            step = wait_for("a step at the lock", lambda: waiting_step(run))
            self.call(["scontrol", "requeue", step.task], folder)
            wait_for("its interruption", lambda: outcomes_of(run).get(step.id))
            check(outcomes_of(run)[step.id]["exit_code"] == 130, f"{outcomes_of(run)}")
        wait_for("an empty queue", lambda: not self.start_requeued())
        answer = waiting.communicate(timeout=PATIENCE_SECONDS)[0]
        check(waiting.returncode == 0 and "torus import: ran" in answer, answer)

    def submitted_run(self):
        folder = self.pipeline("cluster", broken=True)
        with held(self.entry_like(folder, "torus", "trace")):
            answer = self.call([self.strake, "run", "--engine", "slurm"], folder)
            first = runs_in(folder)[0]
            orders = orders_of(first)
            check(f"{len(orders)} steps submitted, 0 in the store" in answer, answer)
            step = wait_for("a step at the lock", lambda: waiting_step(first))
            check("CANARY" not in step.environment, "the shell's environment is in the job's")
            self.kill_node(step, first)
            blocked = with_followers({step.id, f"{BROKEN}.import"}, orders)

            def rest_has_ended():
                self.start_requeued(but=step.task)
                return orders.keys() - outcomes_of(first).keys() <= blocked

            wait_for("all that does not depend on what was lost or broken", rest_has_ended)
            wait_for("what follows the broken model to be cancelled",
                     lambda: BROKEN_INDEX not in self.queue("--format=%K"))
        outcomes = outcomes_of(first)
        check(outcomes[f"{BROKEN}.import"]["exit_code"] == 3, "the broken model is imported")
        check(step.id not in outcomes, "the step that was killed has an outcome")
        left = {name for name in orders
                if outcomes.get(name, {"exit_code": -1})["exit_code"] != 0}

        answer = self.call([self.strake, "run", "--engine", "slurm", "--wait"], folder, 3)
        second = runs_in(folder)[1]
        check(orders_of(second).keys() == left, f"not just the rest: {sorted(orders_of(second))}")
        check("waiting tasks of earlier submissions" in answer, f"nothing cancelled: {answer}")
        made = {name for name, outcome in outcomes_of(second).items()
                if outcome["outcome"] in ("ran", "found")}
        check(made == left - with_followers({f"{BROKEN}.import"}, orders), f"made: {sorted(made)}")

        shutil.copy(self.reference / f"{BROKEN}.ply", folder)
        answer = self.call([self.strake, "submit", "--wait"], folder)
        check(f"{BROKEN} evaluate (seed-1)" in answer, answer)
        check_equal_results(folder, self.reference)
        for command in (["submit"], ["run"]):
            answer = self.call([self.strake, *command], folder)
            check(answer.startswith("0 steps"), answer)
        check(len(runs_in(folder)) == 3, "a run with nothing to do has a folder")
        wait_for("an empty queue", lambda: not self.queue())

    def kill_node(self, step, run):
        """Kills the daemon of a step's node and all that runs there."""
        pid_file = pathlib.Path(self.environment["SLURM_CONF"]).parent / f"slurmd-{step.node}.pid"
        os.kill(int(pid_file.read_text()), signal.SIGKILL)
        victims = [other for other in running_steps(run) if other.node == step.node]
        check(step.pid in [victim.pid for victim in victims], "the waiting step does not run")
        for victim in victims:
            for pid in (victim.parent, victim.pid):
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
        # Slurm would notice after minutes.
        self.call(["scontrol", "update", f"NodeName={step.node}", "State=DOWN", "Reason=killed"],
                  self.folder)

    @staticmethod
    def job_name(run, rule):
        script = next((run / "slurm").glob(f"*-{rule}.sh"), None)
        return re.search(r'--job-name="(.*)"', script.read_text())[1] if script else "none"

    def scripts_by_hand(self):
        folder = self.pipeline("by%20hand")  # "%20h" is something to Slurm
        answer = call([self.strake, "submit", "--script-only", "-o", "job scripts", "saddle/seed-1",
                       "torus/seed-2"], folder, {"PATH": "/nonexistent"})
        submit = folder / "job scripts/submit.sh"
        check(str(submit) in answer, answer)
        run = runs_in(folder)[0]
        with held(self.entry_like(folder, "torus", "tensor")):
            # A shell with options of its own for sbatch, somewhere else.
            call([submit], "/", {**self.environment, "SBATCH_ARRAY_INX": "77"})
            step = wait_for("a step at the lock", lambda: waiting_step(run))
            self.call(["scontrol", "requeue", step.task], folder)
            wait_for("the end of the step", lambda: step.pid not in
                     [other.pid for other in running_steps(run)])
        wait_for("an empty queue", lambda: not self.start_requeued())
        missing = sorted(orders_of(run).keys() - outcomes_of(run).keys())
        check(not missing, f"not run: {missing}")
        check(any((run / "logs").glob("slurm-*_*.txt")), "there are no logs of Slurm")
        check_equal_results(folder, self.reference, r"out/(saddle-seed-1|torus-seed-2)")

    def start_requeued(self, but=None):
        """Has tasks that were put back start soon; Slurm lets them wait two minutes. A node refuses
        them within the second in which they ended there. Returns the queue."""
        for line in self.queue("--states=PENDING", "--format=%i %r"):
            task, reason = line.split(" ", 1)
            if reason == "BeginTime" and task != but and task not in self.put_forward:
                self.put_forward.add(task)
                self.call(["scontrol", "update", f"JobId={task}", "StartTime=now+3"], self.folder)
        return self.queue()


def main():
    # In a short path: it holds a socket. The blank in the other is on purpose.
    with tempfile.TemporaryDirectory(prefix="slurm-") as slurm, \
            tempfile.TemporaryDirectory(prefix="strake slurm ") as folder, \
            private_slurm(slurm) as environment:
        test = SlurmTest(pathlib.Path(folder).resolve(), environment)
        try:
            test.run()
        except (Failed, subprocess.TimeoutExpired) as error:
            print(f"slurm_test: error: {error}", file=sys.stderr)
            print("\n".join(test.queue("--format=%i %T %r %j")), file=sys.stderr)
            return 1
    print("slurm_test: passed")
    return 0


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    sys.exit(main())
