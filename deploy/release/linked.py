#!/usr/bin/python3
"""Lists whose code the programs of a build are really made of, as a table with tabs.

    linked.py BUILD

`library`: loaded when the program starts. `archive`: members of it are part of the program, by the linker's map.
`headers`: included by our sources, whole libraries such as Boost's among them. The licence is that of most files of
the package, as Debian's copyright file states it; where that is prose, those that it names, after `~`.
"""
import pathlib
import re
import subprocess
import sys

PROGRAMS = ("client/traverse", "client/loadgen/traverse-loadgen", "server/traverse-server", "client/gateway/traverse-gateway",
            "deploy/traverse-health-probe")


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def libraries(program):
    return set(re.findall(r"(?m)(?:=> |^\t)(/\S+)", output("ldd", program)))


def archives(program):
    with open(f"{program}.map", encoding="utf-8", errors="replace") as file:
        return {match[1] for match in map(re.compile(r"(/\S+\.a)\(").match, file) if match}


def headers(build):
    """Those of the system that the sources of the product include."""
    found, ours = set(), False
    for line in output("ninja", "-C", build, "-t", "deps").splitlines():
        if not line.startswith(" "):
            ours = not line.startswith("tests/")
        elif ours and line.strip().startswith("/usr/"):
            found.add(line.strip())
    return found


def owners(paths):
    """[path]: the Debian package that brought it."""
    # dpkg knows a file by the path that it was unpacked to, which may be another one by a link.
    names = {name: path for path in paths for name in (path, str(pathlib.Path(path).resolve()),
                                                       path.removeprefix("/usr"), f"/usr{path}")}
    listed = subprocess.run(["dpkg-query", "-S", *sorted(names)], capture_output=True, text=True, check=False).stdout
    found = {}
    for line in listed.splitlines():
        package, _, name = line.rpartition(": ")
        if name in names:
            found[names[name]] = package.split(",")[0].split(":")[0]
    missing = sorted(set(paths) - set(found))
    if missing:
        sys.exit(f"of no package of Debian: {', '.join(missing)}")
    return found


def version(package):
    return output("dpkg-query", "-W", "-f", "${Version}\n", package).splitlines()[0]


def licence(package):
    text = pathlib.Path(f"/usr/share/doc/{package}/copyright").read_text(encoding="utf-8", errors="replace")
    for stanza in re.split(r"\n\s*\n", text):
        files = re.search(r"(?m)^Files:\s*(.*)", stanza)
        stated = re.search(r"(?m)^License:\s*(\S.*)", stanza)
        if files and stated and "*" in files[1].split():
            return stated[1]
    named = sorted(set(re.findall(r"common-licenses/([A-Z][\w.-]*\w)", text)))
    return f"~ {', '.join(named)}" if named else "see its copyright file"


def main():
    build = pathlib.Path(sys.argv[1])
    used = {}  # [how, path]: programs
    for program in PROGRAMS:
        for how, paths in (("library", libraries(build / program)), ("archive", archives(build / program))):
            for path in paths:
                used.setdefault((how, path), set()).add(pathlib.Path(program).name)
    for path in headers(build):
        used["headers", path] = {"all"}
    package_of = owners({path for _, path in used})
    rows = {}
    for (how, path), programs in used.items():
        rows.setdefault((how, package_of[path]), set()).update(programs)
    print("how", "package", "version", "licence", "programs", sep="\t")
    for (how, package), programs in sorted(rows.items()):
        print(how, package, version(package), licence(package), " ".join(sorted(programs)), sep="\t")


if __name__ == "__main__":
    main()
