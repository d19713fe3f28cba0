"""Checks that programs are built so that an overrun ends them: check_hardening.py PROGRAM..."""

import re
import subprocess
import sys


def said(*command):
    return subprocess.run(command, text=True, check=True, stdout=subprocess.PIPE).stdout


def faults(program):
    header = said("readelf", "--wide", "--file-header", "--segments", "--dynamic", program)
    symbols = said("readelf", "--wide", "--dyn-syms", program)
    stack = re.search(r"GNU_STACK.*", header)
    wanted = {
        "it has fixed addresses": re.search(r"Type:\s+DYN", header),
        "it may run what is on the stack": stack and "RWE" not in stack[0],
        "its table of addresses can be written": "GNU_RELRO" in header and "BIND_NOW" in header,
        "its stack has no guards": "__stack_chk_fail" in symbols,
        "copies are not checked": re.search(r"__\w+_chk\b(?<!__stack_chk_fail)", symbols),
    }
    return [f"{program}: {fault}" for fault, is_well in wanted.items() if not is_well]


found = [fault for program in sys.argv[1:] for fault in faults(program)]
print("\n".join(found) or f"{len(sys.argv) - 1} programs are hardened")
sys.exit(1 if found or len(sys.argv) < 2 else 0)
