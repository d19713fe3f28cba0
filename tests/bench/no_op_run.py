#!/usr/bin/env python3
"""Measures `strake run` where there is nothing to do: no_op_run.py BIN_FOLDER [MODELS VARIANTS].

Prints seconds of the first run after everything was made (it reads the outputs once to know them), and
the median of ten more.
"""

import pathlib
import statistics
import subprocess
import sys
import tempfile
import time


def main():
    strake = pathlib.Path(sys.argv[1]).resolve() / "strake"
    models, variants = (int(word) for word in sys.argv[2:4]) if len(sys.argv) > 3 else (10, 5)
    lines = ["version: 1", "models:"]
    lines += [f"  m{m}: {{sample: {{kind: torus, faces: {500 + m}}}}}" for m in range(models)]
    lines += ["options: {evaluate: {samples: 1000}}", "variants:"]
    lines += [f"  v{v}: {{trace: {{seed: {v + 1}}}}}" for v in range(variants)]
    lines += ["outputs:", "  quads: out/{model}-{variant}.obj",
              "  report: out/{model}-{variant}.json"]
    with tempfile.TemporaryDirectory(prefix="strake-bench-") as folder:
        (pathlib.Path(folder) / "pipeline.yaml").write_text("\n".join(lines) + "\n")

        def run():
            begin = time.perf_counter()
            done = subprocess.run([strake, "run"], cwd=folder, check=True, capture_output=True,
                                  text=True)
            return time.perf_counter() - begin, done.stdout.splitlines()[-1]

        seconds, said = run()
        print(f"making all: {seconds:.1f} s ({said})")
        time.sleep(2.5)  # files younger than two seconds are not remembered
        seconds, said = run()
        print(f"first no-op: {seconds:.3f} s ({said})")
        print(f"no-op: {statistics.median(run()[0] for _ in range(10)):.3f} s")


if __name__ == "__main__":
    main()
