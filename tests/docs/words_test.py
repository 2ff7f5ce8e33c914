"""The guides: links, pictures and linked headings exist, lines are short, and codespell knows the words."""
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]


def guides():
    """The Markdown files under version control, or without it all but the build's."""
    listed = subprocess.run(["git", "-C", SOURCE, "ls-files", "*.md"], capture_output=True, text=True, check=False)
    if listed.returncode == 0 and listed.stdout:
        return [SOURCE / name for name in listed.stdout.splitlines()]
    return [path for path in SOURCE.rglob("*.md") if "build" not in path.parts and "node_modules" not in path.parts]


def without_code(text):
    return re.sub(r"`[^`\n]*`", "", re.sub(r"(?ms)^```.*?^```", "", text))


def anchors(text):
    """The names that headings get."""
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")
            for heading in re.findall(r"(?m)^#+ (.*)$", text)}


class Words(unittest.TestCase):
    def test_links_lead_somewhere(self):
        checked = 0
        for guide in guides():
            text = guide.read_text(encoding="utf-8")
            for target in re.findall(r"\]\(([^)\s]+)\)", without_code(text)):
                if re.match(r"https?://|mailto:", target):
                    continue
                with self.subTest(f"{guide.relative_to(SOURCE)}: {target}"):
                    name, _, anchor = target.partition("#")
                    file = (guide.parent / name).resolve() if name else guide
                    self.assertTrue(file.exists(), "no such file")
                    self.assertTrue(file.is_relative_to(SOURCE), "leads out of the project")
                    if anchor:
                        self.assertIn(anchor, anchors(file.read_text(encoding="utf-8")))
                checked += 1
        self.assertGreater(checked, 30)

    def test_no_line_is_longer_than_120_characters(self):
        for guide in guides():
            for number, line in enumerate(guide.read_text(encoding="utf-8").splitlines(), 1):
                self.assertLessEqual(len(line), 120, f"{guide.relative_to(SOURCE)}:{number}")

    def test_no_link_is_plaintext_http(self):
        for guide in guides():
            for link in re.findall(r"\]\((http://[^)]*)\)", guide.read_text(encoding="utf-8")):
                self.assertRegex(link, r"^http://(127\.0\.0\.1|localhost)", guide)

    def test_spelling(self):
        if not shutil.which("codespell"):
            self.skipTest("no codespell")
        texts = [*guides(), *sorted(SOURCE.glob("proto/traverse/v1/*.proto")), *sorted((SOURCE / "client").rglob("*.cc")),
                 *sorted((SOURCE / "client").rglob("*.h")), *sorted((SOURCE / "engine").rglob("*.h")),
                 *sorted((SOURCE / "server").rglob("*.h")), *sorted((SOURCE / "client/view/web/src").iterdir())]
        # Names of people and of variables, and words of other languages.
        known = "limite,mmu,sectionis,sequencial,stoer,tese,theis"
        done = subprocess.run(["codespell", "--ignore-words-list", known, *texts], capture_output=True, text=True, check=False)
        self.assertEqual(done.stdout, "", done.stdout + done.stderr)


if __name__ == "__main__":
    result = unittest.main(exit=False).result
    for _, reason in result.skipped:
        print("SKIPPED:", reason)
    sys.exit(1 if not result.wasSuccessful() else 0)
