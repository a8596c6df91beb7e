#!/usr/bin/env python3
"""scripts/checks/docs.py must find long pages, pages that no index names, long indexes, and names of pages and sections that are gone."""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "checks" / "docs.py"
GOOD = {
    "README.md": "# burr\n\n[pages](docs/README.md)\n",
    "docs/README.md": "# Pages\n\n[use](use/README.md)\n",
    "docs/use/README.md": "# Use\n\n[window](window.md), [touch](devices/touch.md)\n",
    "docs/use/window.md": "# The window\n\n## Milling\n\n## Settings of a hand\n",
    "docs/use/devices/touch.md": "# Touch\n",
    "src/a.h": "// the table of docs" + '/use/window.md, "Milling" and "Settings\n// of a hand"; pages in docs' + "/use/devices/{}.md\n",
}


def run(**changes):
    """The exit status and the words for a checkout of GOOD with these files in place of its own; None: without the file."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in {**GOOD, **changes}.items():
            if text is not None:
                path = pathlib.Path(folder) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
                if path.name == "burr":
                    path.chmod(0o755)
        script = pathlib.Path(folder) / "scripts" / "checks" / "docs.py"
        script.parent.mkdir(parents=True)
        shutil.copy(SCRIPT, script)
        for command in (["init", "-q"], ["add", "-A"]):
            subprocess.run(["git", *command], cwd=folder, check=True)
        done = subprocess.run([sys.executable, script, pathlib.Path(folder) / "no_build"], capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr


class Docs(unittest.TestCase):
    def complains(self, sentence, **changes):
        code, said = run(**changes)
        self.assertEqual(code, 1, said)
        self.assertIn(sentence, said)

    def test_nothing_to_complain_about(self):
        self.assertEqual(run(), (0, "5 documents, 0 complaints\n"))

    def test_a_long_page(self):
        page = GOOD["docs/use/window.md"]
        most = page + "word " * (3000 - len(page.split()))
        self.assertEqual(run(**{"docs/use/window.md": most})[0], 0)
        self.complains("docs/use/window.md: 3001 words, 3000 at most", **{"docs/use/window.md": most + "word"})
        self.assertEqual(run(**{"bench/results/tick.md": "word " * 4000})[0], 0)

    def test_a_page_that_no_index_names(self):
        self.complains("docs/use/README.md: does not name sound.md", **{"docs/use/sound.md": "# Sound\n"})
        self.complains("docs/use/README.md: does not name devices/haply.md", **{"docs/use/devices/haply.md": "# Haply\n"})
        self.complains("docs/README.md: does not name teach/README.md", **{"docs/teach/README.md": "# Teach\n"})

    def test_a_page_that_the_program_prints(self):
        pages = {"docs/use/README.md": GOOD["docs/use/README.md"] + "[settings](settings.md)\n", "docs/use/settings.md": "# Settings\n"}
        program = "#!/bin/sh\n[ \"$*\" = 'settings --markdown' ] && echo '# {}'\n"
        self.assertEqual(run(**pages, **{"no_build/burr": program.format("Settings")})[0], 0)
        self.complains("docs/use/settings.md: is not what the program prints", **pages, **{"no_build/burr": program.format("Other settings")})

    def test_a_folder_without_an_index(self):
        self.complains("docs/teach: has no README.md", **{"docs/teach/school.md": "# School\n"})

    def test_an_index_longer_than_a_screen(self):
        self.complains("docs/use/README.md: 43 lines", **{"docs/use/README.md": GOOD["docs/use/README.md"] + "\n" * 40})

    def test_a_page_that_is_gone(self):
        self.complains("src/b.cpp: names docs" + "/window.md, which is not there", **{"src/b.cpp": "// see docs" + "/window.md.\n"})
        self.complains("README.md: links to docs" + "/gone.md", **{"README.md": "# burr\n\n[gone](docs" + "/gone.md)\n"})

    def test_a_section_that_is_gone(self):
        text = "// docs" + '/use/window.md, "The\n// mirror".\n'
        self.complains('src/b.cpp: names "The mirror" of docs/use/window.md', **{"src/b.cpp": text})

    def test_paths_of_others_are_none_of_ours(self):
        self.assertEqual(run(**{"src/b.cpp": "// https://example.org/docs" + "/gone.md\n"})[0], 0)


if __name__ == "__main__":
    unittest.main()
