"""Each file includes what it uses of the standard library, itself or by a header of ours.

The precompiled headers hide it where one does not: the presets with sanitizers, which do without, would not build.
"""
import functools
import pathlib
import re
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
NAMES = {
    "algorithm": "adjacent_find all_of any_of binary_search clamp copy copy_if copy_n count count_if equal equal_range fill "
                 "fill_n find find_if find_if_not for_each includes lexicographical_compare lower_bound make_heap max "
                 "max_element merge min min_element minmax mismatch none_of nth_element partial_sort partition pop_heap "
                 "push_heap remove remove_if replace reverse rotate set_difference set_intersection shuffle sort "
                 "stable_partition stable_sort transform unique upper_bound",
    "array": "array",
    "atomic": "atomic",
    "bit": "bit_cast bit_width countr_zero popcount",
    "charconv": "from_chars to_chars",
    "chrono": "chrono",
    "cmath": "abs acos atan2 ceil cos exp floor fmod hypot isfinite isnan llround log lround pow round sin sqrt",
    "deque": "deque",
    "functional": "function greater less ref",
    "iterator": "back_inserter make_move_iterator",
    "limits": "numeric_limits",
    "map": "map multimap",
    "memory": "make_shared make_unique shared_ptr unique_ptr weak_ptr",
    "mutex": "lock_guard mutex unique_lock",
    "numeric": "accumulate gcd inclusive_scan iota partial_sum reduce",
    "optional": "nullopt optional",
    "set": "set",
    "string": "string to_string",
    "string_view": "string_view",
    "thread": "thread",
    "tuple": "make_tuple tie tuple",
    "utility": "exchange forward move pair swap",
    "variant": "get_if holds_alternative variant visit",
    "vector": "vector",
}
HEADER_OF = {name: header for header, names in NAMES.items() for name in names.split()}


@functools.cache
def text_of(path):
    return re.sub(r"//.*", "", path.read_text(encoding="utf-8"))


def included(path):
    """All headers that `path` includes, and that those of ours among them include."""
    headers, to_read, read = set(), [path], set()
    while to_read:
        of = to_read.pop()
        read.add(of)
        found = re.findall(r'^#include [<"]([^>"]+)', text_of(of), re.MULTILINE)
        headers.update(found)
        to_read += [SOURCE / name for name in found if (SOURCE / name).exists() and SOURCE / name not in read]
    return headers


def missing(path):
    used = {HEADER_OF[name] for name in re.findall(r"std::(\w+)", text_of(path)) if name in HEADER_OF}
    return sorted(used - included(path))


class Includes(unittest.TestCase):
    def test_no_file_lives_on_the_includes_of_others(self):
        files = [path for room in ("engine", "client", "server", "tests") for path in sorted((SOURCE / room).rglob("*"))
                 if path.suffix in (".h", ".cc")]
        self.assertGreater(len(files), 1000)
        faults = {str(path.relative_to(SOURCE)): headers for path in files if (headers := missing(path))}
        self.assertEqual(faults, {})


if __name__ == "__main__":
    unittest.main()
