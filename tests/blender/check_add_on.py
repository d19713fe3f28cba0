"""Runs the add-on in a Blender without window: check_add_on.py STRAKE ADD_ON.

Exit code 77 (skip) where there is no Blender, in continuous integration too, which does not install it.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

if shutil.which("blender") is None:
    print("skipped: install Blender (scripts/setup --all) to run this test")
    sys.exit(77)

with tempfile.TemporaryDirectory(prefix="strake-blender-") as folder:
    # Settings and add-ons of its own, whatever the user has.
    environment = dict(os.environ, HOME=folder, BLENDER_USER_CONFIG=f"{folder}/config",
                       BLENDER_USER_SCRIPTS=f"{folder}/scripts")
    done = subprocess.run(
        ["blender", "--background", "--factory-startup", "--python",
         pathlib.Path(__file__).with_name("in_blender.py"), "--", *sys.argv[1:]],
        env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
print(done.stdout)
sys.exit(0 if done.returncode == 0 and "the add-on works" in done.stdout else 1)
