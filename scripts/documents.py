"""What the scripts that generate parts of the documents share: the cases, programs, markers."""

import csv
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
# What stands behind this mark in the tutorial is not run by scripts/run_tutorial.
NOT_RUN = "<!-- not run -->"


def script_name():
    return pathlib.Path(sys.argv[0]).name


def fail(message):
    """Ends the script with a message."""
    sys.exit(f"{script_name()}: error: {message}")


def program(name):
    """The path of a built program: in $STRAKE_BIN, else in build/bin."""
    path = pathlib.Path(os.environ.get("STRAKE_BIN") or ROOT / "build" / "bin") / name
    if not path.exists():
        fail(f"there is no {path}; build strake, or set STRAKE_BIN to the folder of its programs")
    return str(path)


def models_folder():
    """The folder of the test models: $STRAKE_MODELS, else ../shared/models beside the tree."""
    return pathlib.Path(os.environ.get("STRAKE_MODELS") or ROOT.parent / "shared" / "models")


def model(name):
    """The path of a test model."""
    path = models_folder() / name
    if not path.exists():
        fail(f"there is no {path}; set STRAKE_MODELS to the folder of the test models")
    return str(path)


def cases():
    """The rows of docs/cases.csv."""
    with open(ROOT / "docs" / "cases.csv", encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def peer_figures():
    """The rows of docs/peers.csv: measured figures of other programs, as docs/quality.md describes."""
    with open(ROOT / "docs" / "peers.csv", encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def peer_near(model_name, vertices, programs):
    """The row of the first of these programs that was measured at about a count; None where none was."""
    for name in programs:
        for row in peer_figures():
            if (row["model"], row["program"]) == (model_name, name) and \
                    abs(int(row["vertices"]) / vertices - 1) < 0.1:
                return row
    return None


class ProgramFailed(SystemExit):
    """A program returned an error; ends the script unless caught."""


def output_of(*command):
    """What a command prints."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise ProgramFailed(f"{script_name()}: error: '{' '.join(command)}' returned "
                            f"{done.returncode}:\n{done.stderr}")
    return done.stdout


def run_in(folder, command):
    """What a command line of a document prints on stdout, run in a folder with the programs at hand."""
    programs = pathlib.Path(program("strake")).resolve().parent
    environment = dict(os.environ, PATH=f"{programs}:{os.environ['PATH']}")
    done = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, capture_output=True,
                          text=True, check=False)
    if done.returncode != 0:
        fail(f"'{command}' returned {done.returncode}:\n{done.stderr}")
    return done.stdout


def with_generated(text, name, block, path):
    """The text with what stands between the markers of `name` replaced by `block`."""
    begin, end = f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->"
    if text.count(begin) != 1 or text.count(end) != 1:
        fail(f"{path} must have the lines '{begin.strip()}' and '{end}' once each")
    head, rest = text.split(begin)
    return f"{head}{begin}{block}{end}{rest.split(end)[1]}"
