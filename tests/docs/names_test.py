"""Each type has one definition: two of a name in one namespace are mixed by the linker, which says nothing."""
import collections
import pathlib
import re
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
TYPE = re.compile(r"(?:struct|class|enum class|enum|union) (?:\w+\([^)]*\) |ABSL_\w+ )?(\w+)(?: final)?(?: : .*)? \{")


def types(text):
    """The namespace and the name of each type that other files can clash with."""
    spaces = []
    for line in text.splitlines():
        if opened := re.fullmatch(r"(?:inline )?namespace ?([\w:]*) \{", line):
            spaces.append(opened[1])
        elif re.fullmatch(r"\}  // namespace ?[\w:]*", line):
            spaces.pop()
        elif (found := TYPE.match(line)) and "" not in spaces:
            yield "::".join(spaces), found[1]


class Names(unittest.TestCase):
    def test_each_type_is_defined_once(self):
        places = collections.defaultdict(set)
        for room in ("engine", "client", "server"):
            for path in sorted((SOURCE / room).rglob("*")):
                if path.suffix in (".h", ".cc"):
                    for name in types(path.read_text(encoding="utf-8")):
                        places[name].add(str(path.relative_to(SOURCE)))
        self.assertGreater(len(places), 500)
        self.assertEqual({name: where for name, where in places.items() if len(where) > 1}, {})

    def test_what_is_unnamed_clashes_with_nothing(self):
        text = "namespace a {\nstruct B {\n};\nnamespace {\nclass C : public B {\n}  // namespace\nenum class D {\n"
        self.assertEqual(list(types(text)), [("a", "B"), ("a", "D")])


if __name__ == "__main__":
    unittest.main()
