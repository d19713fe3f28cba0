"""What the suites of torture.py share."""

import subprocess

SEED = 20041007
PATIENCE_SECONDS = 200  # for what takes one, beside other tests


def check(condition, *what):
    if not condition:
        raise AssertionError(" ".join(str(part) for part in what))


def mount(folder, options):
    folder.mkdir(parents=True, exist_ok=True)
    subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", str(folder)], check=True)
