"""The page of --report in headless Chromium: makes reports with the built command, then runs page_test.mjs on them.

Skips without Node, npm or Chromium. TRAVERSE_SCREENSHOTS names a folder that gets pictures of the page.
"""
import math
import os
import random
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.normpath(os.path.join(HERE, *[os.pardir] * 4))
sys.path.append(SOURCE)
from tests.support import node_packages

SAMPLES = os.path.join(SOURCE, "deploy", "samples")
TRAVERSE = os.environ["TRAVERSE"]
SKIPPED = 77


def skip(reason):
    print("SKIPPED:", reason)
    sys.exit(SKIPPED)


def browser():
    for name in ("chromium", "chromium-browser", "google-chrome"):
        if shutil.which(name):
            return shutil.which(name)
    return skip("no Chromium")


def write_large_part(path):
    """200 layers of 100 islands with 4 contours of 8 to 20 points and 6 rasters; every tenth layer is the same."""
    numbers = random.Random(1)
    layers = []
    for _ in range(10):
        lines = []
        for island in range(1, 101):
            lines.append(f"I{island},4,6")
            x, y = numbers.uniform(20, 280), numbers.uniform(20, 280)
            for contour in range(1, 5):
                radius, points, turn = 3 + 2 * contour, numbers.randint(8, 20), numbers.uniform(0, 6)
                angles = [turn + 2 * math.pi * i / points for i in range(points)]
                lines.append(f"C{contour}," + ",".join(
                    f"X{x + radius * math.cos(a):.4f},Y{y + radius * math.sin(a):.4f}" for a in angles))
            for raster in range(1, 7):
                lines.append(f"R{raster},X{x - 4:.4f},Y{y - 4 + raster:.4f},"
                             f"X{x + 4:.4f},Y{y - 4 + raster + numbers.random():.4f}")
        layers.append("\n".join(lines) + "\n")
    with open(path, "w", encoding="ascii") as file:
        file.write("nF,200\n" + "".join(f"F{layer + 1},100\n{layers[layer % 10]}" for layer in range(200)))


def main():
    chromium = browser()
    with tempfile.TemporaryDirectory() as folder:
        for name in ("package.json", "package-lock.json", "page_test.mjs"):
            shutil.copy(os.path.join(HERE, name), folder)
        shutil.copytree(os.path.join(SOURCE, "client", "view", "web", "src"), os.path.join(folder, "src"))
        missing = node_packages.install(folder)
        if missing:
            skip(missing)

        def report(command, part, page, *flags):
            subprocess.run([TRAVERSE, command, part, "--quiet", f"--report={os.path.join(folder, page)}", *flags],
                           check=True, stdout=subprocess.DEVNULL)

        part = os.path.join(SAMPLES, "part2.damat")
        hostile = os.path.join(folder, "<img src=x onerror=document.title='broken'>.damat")
        shutil.copy(part, hostile)
        large = os.path.join(folder, "large.damat")
        write_large_part(large)
        report("compare", part, "compare.html", "--strategies=greedy,ni2opt")
        report("optimize", hostile, "hostile.html", "--strategy=greedy")
        report("optimize", os.path.join(SAMPLES, "clusters13.gcode"), "gcode.html", "--policy=balanced",
               "--strategy=ni2opt", "-o", os.path.join(folder, "shorter.gcode"))
        report("optimize", large, "large.html", "--strategy=greedy")

        environment = {**os.environ, "CHROMIUM": chromium, "REPORTS": folder}
        sys.exit(subprocess.run(["node", "--test", "--test-reporter=spec", "page_test.mjs"], cwd=folder,
                                env=environment).returncode)


main()
