#!/usr/bin/env python3
"""A Slurm of one's own for tests and trials: private_slurm.py FOLDER [NODES].

Starts munged, slurmctld and NODES (default 3) slurmd with two processors each, on loopback and free
ports, with all their files in FOLDER, whose path has to be short (it holds a socket). Says

    ready FOLDER/slurm.conf

once all nodes are idle; with SLURM_CONF set to that file, sbatch and squeue talk to this Slurm. It
ends with its standard input, or with SIGTERM or SIGINT, and takes every process with it that it or
its jobs started. It never touches a Slurm of the system.
"""

import ctypes
import os
import pathlib
import signal
import socket
import subprocess
import sys
import threading
import time

PR_SET_PDEATHSIG = 1
PR_SET_CHILD_SUBREAPER = 36
START_SECONDS = 60

CONF = """\
ClusterName=private
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ctld_port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.sock
CredType=cred/munge
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerParameters=bf_interval=1,sched_interval=1
SlurmdParameters=config_overrides
ReturnToService=2
# A node that is only slow, on a busy machine, is not taken for dead.
SlurmdTimeout=300
KillWait=2
MinJobAge=300
DefMemPerCPU=500
MailProg=/bin/true
# Not the environment of a login shell, which may take seconds for each job.
GetEnvTimeout=0
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool/%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd-%n.log
"""
NODE = "NodeName=n{n} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs=2 RealMemory=4000\n"
PARTITION = "PartitionName=main Nodes=n[1-{nodes}] Default=YES MaxTime=INFINITE State=UP\n"


def prctl(option, value):
    if ctypes.CDLL(None, use_errno=True).prctl(option, value, 0, 0, 0) != 0:
        raise OSError(ctypes.get_errno(), "prctl")


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def descendants():
    """Processes that this one or any of its children started, as far as they still run."""
    parents = {}
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            # pid (name) state parent; the name may hold anything
            fields = stat.read_text(errors="replace").rpartition(")")[2].split()
        except OSError:
            continue
        parents[int(stat.parent.name)] = int(fields[1])
    found = []
    for pid in parents:
        ancestor = pid
        while ancestor in parents and ancestor != os.getpid():
            ancestor = parents[ancestor]
        if ancestor == os.getpid() and pid != ancestor:
            found.append(pid)
    return found


def reap():
    """Takes note of children that have ended."""
    try:
        while os.waitpid(-1, os.WNOHANG) != (0, 0):
            pass
    except ChildProcessError:
        pass


def end_all():
    """Kills until nothing is left: what is killed may just have started something."""
    while pids := descendants():
        for pid in pids:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        reap()
        time.sleep(0.02)


def start(command, environment, output):
    subprocess.Popen(command, env=environment, stdin=subprocess.DEVNULL, stdout=output,
                     stderr=output, preexec_fn=lambda: prctl(PR_SET_PDEATHSIG, signal.SIGKILL))


def write_files(folder, nodes):
    for name in ("state", "spool"):
        (folder / name).mkdir()
    key = folder / "munge.key"
    key.write_bytes(os.urandom(128))
    key.chmod(0o400)
    host = socket.gethostname().partition(".")[0]
    ports = free_ports(nodes + 1)
    user = subprocess.run(["id", "-un"], check=True, capture_output=True, text=True).stdout.strip()
    conf = CONF.format(folder=folder, host=host, user=user, ctld_port=ports[0])
    for n in range(1, nodes + 1):
        conf += NODE.format(n=n, host=host, port=ports[n])
    (folder / "slurm.conf").write_text(conf + PARTITION.format(nodes=nodes))


def start_all(folder, nodes):
    output = (folder / "daemons.log").open("w")
    environment = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "SLURM_CONF": f"{folder}/slurm.conf"}
    start(["munged", "--foreground", "--force", f"--key-file={folder}/munge.key",
           f"--socket={folder}/munge.sock", f"--pid-file={folder}/munged.pid",
           f"--log-file={folder}/munged.log", f"--seed-file={folder}/munge.seed"],
          environment, output)
    deadline = time.monotonic() + START_SECONDS
    while not (folder / "munge.sock").exists() and time.monotonic() < deadline:
        time.sleep(0.02)
    start(["slurmctld", "-D", "-i", "-f", environment["SLURM_CONF"]], environment, output)
    for n in range(1, nodes + 1):
        start(["slurmd", "-D", "-f", environment["SLURM_CONF"], "-N", f"n{n}"], environment, output)
    while time.monotonic() < deadline:
        states = subprocess.run(["sinfo", "--noheader", "--Node", "--format=%T"], env=environment,
                                capture_output=True, text=True).stdout.split()
        if states == ["idle"] * nodes:
            return
        time.sleep(0.1)
    print((folder / "daemons.log").read_text(errors="replace"), file=sys.stderr)
    raise SystemExit(f"private_slurm: error: Slurm did not start within {START_SECONDS} s")


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    nodes = int(sys.argv[2]) if len(sys.argv) > 2 else 3
    folder.mkdir(parents=True, exist_ok=True)
    prctl(PR_SET_CHILD_SUBREAPER, 1)  # what daemons leave behind becomes a child of this process
    ended = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        signal.signal(number, lambda *_: ended.set())

    def wait_for_input_to_end():
        sys.stdin.buffer.read()
        ended.set()

    try:
        write_files(folder, nodes)
        start_all(folder, nodes)
        print(f"ready {folder}/slurm.conf", flush=True)
        threading.Thread(target=wait_for_input_to_end, daemon=True).start()
        while not ended.wait(0.2):
            reap()
    finally:
        end_all()


if __name__ == "__main__":
    main()
