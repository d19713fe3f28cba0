"""What the programs offer people at a terminal: completion, manual pages, suggestions, colours.

The real programs are in the folder $STRAKE_BIN.
"""

import os
import pathlib
import pty
import re
import select
import shutil
import subprocess
import tempfile
import unittest

BIN = pathlib.Path(os.environ["STRAKE_BIN"])
PROGRAMS = sorted(path.name for path in BIN.glob("strake*")
                  if os.access(path, os.X_OK) and "bench" not in path.name)


def output_of(*words, **settings):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, check=True,
                          **settings).stdout


def said(*words):
    """Exit code and stderr of a program."""
    done = subprocess.run([BIN / words[0], *words[1:]], capture_output=True, text=True)
    return done.returncode, done.stderr


def is_there(program):
    """Whether a program can be called; in continuous integration it has to be there."""
    return shutil.which(program) is not None or bool(os.environ.get("CI"))


def options_of(help_text):
    """The options that a help text or a manual page lists, not those that sentences name."""
    return set(re.findall(r"^ +(?:-\w,\s*)?(--[a-z][\w-]*)", help_text, re.M))


class Completion(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.script = pathlib.Path(cls.folder.name) / "strake.bash"
        cls.script.write_text(output_of(BIN / "strake", "completion", "bash"))
        (pathlib.Path(cls.folder.name) / "a mesh.ply").touch()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def complete(self, *words, program="strake", script=None):
        """What bash offers for the last word."""
        line = " ".join(f"'{word}'" for word in words)
        code = (f"source '{script or self.script}'; COMP_WORDS=({program} {line}); "
                f"COMP_CWORD={len(words)}; $(complete -p {program} | sed 's/.*-F \\([^ ]*\\).*/\\1/'); "
                "printf '%s\\n' \"${COMPREPLY[@]}\"")
        return set(output_of("bash", "-c", code, cwd=self.folder.name).split("\n")) - {""}

    def test_bash_offers_commands(self):
        offered = self.complete("")
        self.assertLessEqual({"remesh", "info", "check", "run", "completion", "man"}, offered)
        self.assertEqual(self.complete("rem"), {"remesh"})

    def test_bash_offers_options_of_the_command(self):
        self.assertEqual(self.complete("remesh", "--vert"), {"--vertices"})
        self.assertEqual(self.complete("check", "--"),
                         options_of(output_of(BIN / "strake", "check", "--help")))

    def test_bash_offers_every_option_that_help_names(self):
        for command in ("remesh", "run", "gc", "status"):
            named = options_of(output_of(BIN / "strake", command, "--help"))
            self.assertLessEqual(named, self.complete(command, "--"), command)

    def test_bash_offers_values(self):
        self.assertEqual(self.complete("remesh", "--extension", ""), {"cross", "paper"})
        self.assertEqual(self.complete("remesh", "a.ply", "--vertices", ""), set())
        self.assertLessEqual({"torus", "part"}, self.complete("sample", ""))
        self.assertEqual(self.complete("completion", ""), {"bash", "zsh", "fish"})

    def test_bash_offers_files(self):
        self.assertEqual(self.complete("remesh", "a"), {"a mesh.ply"})
        self.assertEqual(self.complete("remesh", "x.ply", "-o", "a"), {"a mesh.ply"})
        self.assertEqual(self.complete("remesh", "x.ply", "--keep", "a"), set())  # folders only

    def test_every_program_has_scripts_that_shells_parse(self):
        for program in PROGRAMS:
            for shell in ("bash", "zsh", "fish"):
                if not is_there(shell):
                    continue
                path = pathlib.Path(self.folder.name) / f"script.{shell}"
                path.write_text(output_of(BIN / program, "--generate", shell))
                output_of(shell, "-n", path)
                if shell == "bash":
                    named = options_of(output_of(BIN / program, "--help"))
                    offered = self.complete("--", program=program, script=path)
                    self.assertLessEqual(named - {"--keep"}, offered, program)

    @unittest.skipUnless(is_there("fish"), "needs fish")
    def test_fish_offers_the_same(self):
        path = pathlib.Path(self.folder.name) / "strake.fish"
        path.write_text(output_of(BIN / "strake", "completion", "fish"))
        def complete(line):
            text = output_of("fish", "--no-config", "-c", f"source {path}; complete -C '{line}'",
                             cwd=self.folder.name, env=dict(os.environ, HOME=self.folder.name))
            return {offer.split("\t")[0] for offer in text.splitlines()}
        self.assertEqual(complete("strake rem"), {"remesh"})
        self.assertEqual(complete("strake remesh --vert"), {"--vertices"})
        self.assertEqual(complete("strake remesh --extension "), {"cross", "paper"})

    @unittest.skipUnless(is_there("zsh"), "needs zsh")
    def test_zsh_loads_the_script(self):
        code = ("autoload -U compinit; compinit -u -D; source <(\"$1\" completion zsh); "
                "print -r -- $_comps[strake]; whence -w _strake_remesh")
        said_by_zsh = output_of("zsh", "-f", "-c", code, "zsh", BIN / "strake",
                                env=dict(os.environ, HOME=self.folder.name))
        self.assertEqual(said_by_zsh.splitlines(), ["_strake", "_strake_remesh: function"])

    def test_unknown_shell(self):
        code, message = said("strake", "completion", "tcsh")
        self.assertEqual(code, 2)
        self.assertIn("bash, zsh and fish", message)


class Manual(unittest.TestCase):
    @unittest.skipUnless(is_there("groff"), "needs groff")
    def test_pages_are_clean_and_complete(self):
        for program in PROGRAMS:
            page = output_of(BIN / program, "--generate", "man")
            done = subprocess.run(["groff", "-man", "-ww", "-Tutf8"], input=page,
                                  capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""), program)
            text = re.sub(r"\x1b\[[\d;]*m|.\x08", "", done.stdout).replace("\u2010", "-")
            self.assertLessEqual(options_of(output_of(BIN / program, "--help")), options_of(text),
                                 program)
            self.assertEqual(len(re.findall(r"--help\b", text.split("COMMANDS")[0])), 1, program)
            for section in ("NAME", "SYNOPSIS", "OPTIONS", "EXIT STATUS"):
                self.assertIn(section, text)

    @unittest.skipUnless(is_there("man"), "needs man")
    def test_man_takes_what_the_command_prints(self):
        done = subprocess.run(["man", "--warnings", "-l", "-"], text=True, capture_output=True,
                              input=output_of(BIN / "strake", "man"),
                              env=dict(os.environ, MANPAGER="cat", MANWIDTH="100", LC_ALL="C.UTF-8"))
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for command in ("remesh", "info", "sample", "run", "gc", "completion"):
            self.assertRegex(done.stdout, rf"strake[-\u2010 ]+{command}\b")
        self.assertIn("strake remesh part.ply -o quads.obj", done.stdout)


class Suggestions(unittest.TestCase):
    def test_options_and_commands(self):
        for words, meant in (
                (("strake", "remsh", "a.ply"), "remesh"),
                (("strake", "remesh", "a.ply", "-o", "b.obj", "--tolerence", "1%"), "--tolerance"),
                (("strake", "remesh", "a.ply", "-o", "b.obj", "--vertcies=9"), "--vertices"),
                (("strake", "remesh", "a.ply", "--outptu", "b.obj"), "--output"),
                (("strake", "remesh", "a.ply", "-o", "b.obj", "--pure"), "--pure-quads"),
                (("strake-tensor", "mesh.hdf", "-o", "t.hdf", "--radios", "1%"), "--radius")):
            code, message = said(*words)
            self.assertEqual(code, 2, message)
            self.assertIn(f"did you mean '{meant}'?", message)
            self.assertRegex(message, r"there is no (option '--|command ')")

    def test_a_number_behind_a_flag(self):
        for words in (("remesh", "a.ply", "-o", "b.obj", "-v", "5000"), ("remesh", "a.ply", "-v", "5000")):
            code, message = said("strake", *words)
            self.assertEqual(code, 2, message)
            self.assertIn("'-v' is '--verbose' and takes no value; did you mean '--vertices 5000'?", message)
        code, message = said("strake", "remesh", "a.ply", "-o", "b.obj", "5000")
        self.assertEqual(code, 2, message)
        self.assertNotIn("did you mean", message)

    def test_stages_are_programs_of_their_own(self):
        for word, meant in (("trace", "strake-trace"), ("smoth", "strake-smooth"), ("render", "strake-render")):
            code, message = said("strake", word, "mesh.hdf")
            self.assertEqual(code, 2, message)
            self.assertIn(f"there is no command '{word}'; did you mean the program '{meant}'?", message)

    def test_nothing_near_is_not_guessed(self):
        for words in (("strake", "chocolate"), ("strake-tensor", "m.hdf", "-o", "t.hdf", "--chocolate")):
            code, message = said(*words)
            self.assertEqual(code, 2)
            self.assertNotIn("did you mean", message)
            self.assertIn("chocolate", message)

    def test_shares_are_one_word(self):
        for words in (("strake", "remesh", "a.ply", "-o", "b.obj", "--tolerance", "0.1", "%"),
                      ("strake-tensor", "mesh.hdf", "-o", "t.hdf", "--radius", "1", "%")):
            code, message = said(*words)
            self.assertEqual(code, 2, message)
            self.assertIn("without a blank, as in 0.1%", message)


class Help(unittest.TestCase):
    def test_teaches_by_example(self):
        commands = re.findall(r"^  (\w+) ", output_of(BIN / "strake", "--help").split("Subcommands:")[1]
                              .split("Examples:")[0], re.MULTILINE)
        self.assertIn("remesh", commands)
        for words in [(program,) for program in PROGRAMS] + [("strake", command) for command in commands]:
            shown = output_of(BIN / words[0], *words[1:], "--help")
            if words != ("strake", "step"):  # for engines only
                self.assertRegex(shown, r"Examples?:\n  " + " ".join(words) + r"\b", words)


class Version(unittest.TestCase):
    def test_says_how_it_was_built(self):
        for program in PROGRAMS:
            lines = output_of(BIN / program, "--version").splitlines()
            self.assertRegex(lines[0], rf"^{program} \d+\.\d+\.\d+$")
            self.assertRegex(lines[1], r"^built by (GNU|Clang) \d+[\d.]*, \w+$")
            for library in ("Eigen", "oneTBB", "Embree", "HDF5"):
                self.assertRegex(lines[2], rf"{library} \d+\.\d+")


def on_terminal(*words, **environment):
    """What a program writes where stdout and stderr are a terminal."""
    leader, follower = pty.openpty()
    settings = {key: value for key, value in os.environ.items() if key != "NO_COLOR"}
    settings.update({"TERM": "xterm", **environment})
    process = subprocess.Popen([BIN / words[0], *words[1:]], stdout=follower, stderr=follower,
                               stdin=subprocess.DEVNULL, env=settings)
    os.close(follower)
    text = b""
    while True:
        try:
            part = os.read(leader, 65536) if select.select([leader], [], [], 120)[0] else b""
        except OSError:
            break  # the terminal has nobody left
        if not part:
            break
        text += part
    os.close(leader)
    process.wait()
    return text.decode()


class Terminal(unittest.TestCase):
    RED = "\x1b[1;31m"

    def test_colours_only_on_terminals_that_want_them(self):
        words = ("strake", "info", "nowhere.obj")
        self.assertIn(f"strake: {self.RED}error: ", on_terminal(*words))
        self.assertNotIn(self.RED, on_terminal(*words, NO_COLOR="1"))
        self.assertNotIn(self.RED, on_terminal(*words, TERM="dumb"))
        self.assertIn(self.RED, on_terminal(*words, NO_COLOR=""))
        self.assertNotIn("\x1b", said(*words)[1])

    def test_long_work_tells_pace_and_time_left(self):
        with tempfile.TemporaryDirectory() as folder:
            mesh = pathlib.Path(folder) / "torus.ply"
            output_of(BIN / "strake", "sample", "torus", "--faces", "150000", "-o", mesh)
            output_of(BIN / "strake-import", mesh, "-o", mesh.with_name("mesh.hdf"), "-q")
            shown = on_terminal("strake-tensor", str(mesh.with_name("mesh.hdf")), "-o",
                                str(mesh.with_name("tensor.hdf")), "--radius", "5%", "--threads", "1")
        self.assertRegex(shown, r"tensor +\[=+ +\] +\d+ % [\w ]+, [\d.e+]+ %/s, \d+ (s|min) left")
        # The bar is gone in the end.
        self.assertTrue(shown.endswith("\r\x1b[K"), repr(shown[-200:]))


if __name__ == "__main__":
    unittest.main()
