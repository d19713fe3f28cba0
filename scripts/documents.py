"""What the scripts that generate parts of the documents share: the cases, programs, markers."""

import csv
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]


def fail(message):
    """Ends the script with a message."""
    sys.exit(f"{pathlib.Path(sys.argv[0]).name}: error: {message}")


def program(name):
    """The path of a built program: in $STRAKE_BIN, else in build/bin."""
    path = pathlib.Path(os.environ.get("STRAKE_BIN") or ROOT / "build" / "bin") / name
    if not path.exists():
        fail(f"there is no {path}; build strake, or set STRAKE_BIN to the folder of its programs")
    return str(path)


def model(name):
    """The path of a test model: in $STRAKE_MODELS, else in ../shared/models beside the tree."""
    folder = pathlib.Path(os.environ.get("STRAKE_MODELS") or ROOT.parent / "shared" / "models")
    if not (folder / name).exists():
        fail(f"there is no {folder / name}; set STRAKE_MODELS to the folder of the test models")
    return str(folder / name)


def cases():
    """The rows of docs/cases.csv."""
    with open(ROOT / "docs" / "cases.csv", encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def output_of(*command):
    """What a command prints; ends the script where it fails."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        fail(f"'{' '.join(command)}' returned {done.returncode}:\n{done.stderr}")
    return done.stdout


def with_generated(text, name, block, path):
    """The text with what stands between the markers of `name` replaced by `block`."""
    begin, end = f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->"
    if text.count(begin) != 1 or text.count(end) != 1:
        fail(f"{path} must have the lines '{begin.strip()}' and '{end}' once each")
    head, rest = text.split(begin)
    return f"{head}{begin}{block}{end}{rest.split(end)[1]}"
