#!/usr/bin/env python3
"""The judge finds what is planted, says nothing of a legal copy, and keeps a small part that still fails."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import checks  # noqa: E402
import generate  # noqa: E402
import judge  # noqa: E402
import print_trace  # noqa: E402
import shrink  # noqa: E402
import vary  # noqa: E402

HEAD = ["M83", "G90", "; nozzle_diameter = 0.4"]


def block(x, z, feed=1800, e=0.3):
    """A square of 10 mm at height z with its layer's comment."""
    corners = [(x, 10), (x + 10, 10), (x + 10, 20), (x, 20), (x, 10)]
    travel = f"G1 X{x} Y10 F9000"
    return [travel, f"G1 F{feed}"] + [f"G1 X{a} Y{b} E{e}" for a, b in corners[1:]]


def layer(z, *blocks):
    return [";LAYER_CHANGE", f"G1 Z{z} F9000"] + [line for lines in blocks for line in lines]


def faults(before, after, policy="safe"):
    options = judge.Options(policy, 10.0, 0.131)
    old, new = (print_trace.trace("\n".join(lines)) for lines in (before, after))
    return {judge.kind(fault) for check in checks.ALL.values() for fault in check(old, new, options)}


class Checks(unittest.TestCase):
    towers = HEAD + layer(0.2, block(10, 0.2), block(40, 0.2)) + layer(0.4, block(10, 0.4), block(40, 0.4))

    def test_the_same_file_has_no_fault(self):
        self.assertEqual(faults(self.towers, self.towers), set())

    def test_paths_may_change_places(self):
        after = HEAD + layer(0.2, block(40, 0.2), block(10, 0.2)) + layer(0.4, block(40, 0.4), block(10, 0.4))

        self.assertEqual(faults(self.towers, after), set())

    def test_a_park_that_is_left_out_is_found(self):
        def print_with(script):
            first, second = (layer(z, block(10, z), block(40, z)) for z in (0.2, 0.4))
            return HEAD + first + second[:2] + script + second[2:]

        park = print_with(["G1 X1 Y90 F9000"])
        self.assertEqual(faults(park, park), set())
        self.assertIn("asides", faults(park, print_with([])))

    def test_a_lost_path_is_found(self):
        after = HEAD + layer(0.2, block(10, 0.2), block(40, 0.2)) + layer(0.4, block(10, 0.4))

        self.assertIn("deposits", faults(self.towers, after))

    def test_another_feed_rate_is_found(self):
        after = HEAD + layer(0.2, block(10, 0.2), block(40, 0.2)) + layer(0.4, block(10, 0.4), block(40, 0.4, feed=2400))

        self.assertIn("deposits", faults(self.towers, after))

    def test_another_setting_is_found(self):
        for setting in ("M900 K0.{} L1000 M10", "M233 X0.{0} Y0.{0}", "M566 X{}", "M207 X{}", "M215 X{}", "M221 S{}",
                        "M593 F{}", "M220 S{}", "SET_FAN_SPEED FAN=aux SPEED=0.{}", "SET_INPUT_SHAPER SHAPER_FREQ_X={}"):
            before = HEAD + [setting.format(20)] + self.towers[len(HEAD):]
            at = before.index(";LAYER_CHANGE", len(HEAD) + 2)
            after = before[:at] + [setting.format(30)] + before[at:]

            self.assertIn("deposits", faults(before, after), setting)

    def test_printing_with_filament_pulled_back_is_found(self):
        at = len(HEAD) + 2
        after = self.towers[:at] + ["G1 E-0.8 F2100"] + self.towers[at:]

        self.assertIn("filament", faults(self.towers, after))

    def test_what_a_tool_lacks_behind_its_change_may_be_pushed_along_other_paths(self):
        purge = ["G1 E-1 F2100"]
        before = HEAD + layer(0.2, purge, block(10, 0.2, e=0.6), block(40, 0.2))
        after = HEAD + layer(0.2, purge, block(40, 0.2), block(10, 0.2, e=0.6))

        self.assertNotIn("filament", faults(before, after))

    def test_what_the_nozzle_lacks_in_both_may_be_lacking_in_a_longer_path(self):
        lacks = ["G1 E-0.8 F2100", "G1 E0.77"]
        before = HEAD + layer(0.2, lacks, block(10, 0.2, e=0.1), block(40, 0.2))
        after = HEAD + layer(0.2, lacks, block(40, 0.2), block(10, 0.2, e=0.1))

        self.assertNotIn("filament", faults(before, after))

    def test_a_lack_is_the_same_in_many_short_lines_and_in_a_long_one(self):
        lacks = ["G1 E-0.8 F2100", "G1 E0.7"]
        before, after = HEAD, HEAD
        for z in (0.2, 0.4, 0.6):
            before = before + layer(z, lacks, block(10, z, e=0.09), block(40, z))
            after = after + layer(z, lacks, block(40, z), block(10, z, e=0.09))

        self.assertNotIn("filament", faults(before, after))

    def test_a_layer_goes_on_behind_a_scarf_seam(self):
        seam = ["G1 X60 Y10 F9000", "G1 Z0.25 F9000", "G1 F1800", "G1 X60 Y15 Z0.3 E0.1", "G1 X60 Y20 Z0.4 E0.1"]
        layers = checks.layers_of(print_trace.trace("\n".join(
            HEAD + layer(0.2, block(10, 0.2)) + layer(0.4, block(10, 0.4), seam, block(40, 0.4)))))
        begun = checks.layers_of(print_trace.trace("\n".join(
            HEAD + layer(0.2, block(10, 0.2)) + layer(0.4, seam, block(10, 0.4), block(40, 0.4)))))

        self.assertEqual([(z, len(moves)) for z, moves in layers], [(0.2, 4), (0.4, 10)])
        self.assertEqual([(z, len(moves)) for z, moves in begun], [(0.2, 4), (0.4, 10)])

    def test_less_rest_is_found_where_the_policy_keeps_it(self):
        after = HEAD + layer(0.2, block(10, 0.2), block(40, 0.2)) + layer(0.4, block(40, 0.4), block(10, 0.4))

        self.assertIn("rest", faults(self.towers, after))
        self.assertEqual(faults(self.towers, after, "free"), set())

    def test_islands_of_many_short_moves_rest_in_seconds(self):
        def tower(x):  # of 10 s
            steps = [f"G1 X{x + n % 2} Y{10 + n / 100:g} E0.01" for n in range(1, 301)]
            return [f"G1 X{x} Y10 F9000", "G1 F1800"] + steps

        def rows(*towers):
            return HEAD + [line for n in (1, 2, 3) for line in layer(0.2 * n, *towers)]

        before = rows(tower(10), ["G1 X200 Y200 F18000"], tower(40))
        turned = HEAD + rows(tower(10), tower(40))[len(HEAD):-len(layer(0, tower(10), tower(40)))]

        self.assertEqual(faults(before, rows(tower(10), tower(40))), set())
        self.assertIn("rest", faults(before, turned + layer(0.6, tower(40), tower(10))))

    def test_an_island_that_is_printed_twice_running_needs_no_rest(self):
        away = ["G1 X20 Y21 F90"]  # of 10 s
        before = HEAD + layer(0.2, block(10, 0.2)) + layer(0.4, away, block(10, 0.4))
        after = HEAD + layer(0.2, block(10, 0.2)) + layer(0.4, block(10, 0.4))

        self.assertEqual(faults(before, after), set())

    def test_the_least_layer_time_is_read_from_the_files_of_many_slicers(self):
        for line in ("; slow_down_layer_time = 3", "; slowdown_below_layer_time = 3", "; min_layer_time_sec : \t3",
                     ";   cool_min_layer_time,3"):
            self.assertEqual(judge.options_of(f"; x\n{line}\n", "safe").least_layer_s, 3, line)
        self.assertEqual(judge.options_of("; enable_min_layer_time : False\n", "safe").least_layer_s, 10)

    def test_less_rest_of_islands_that_count_as_one_is_found(self):
        pair, far = [block(10.4, 0), block(21.6, 0)], [block(60, 0), block(90, 0)]  # 1.2 mm apart
        before = HEAD + layer(0.2, *pair, *far) + layer(0.4, *pair, *far)
        again = HEAD + layer(0.2, pair[0], *far, pair[1]) + layer(0.4, pair[0], *far, pair[1])

        self.assertIn("rest", faults(before, again))

    def test_travel_is_as_low_as_the_original_prints(self):
        high = HEAD + layer(0.4, block(10, 0.4))
        low = layer(0.2, block(10, 0.2))
        beside = [line for line in low if not line.endswith("E0.3")] + ["G1 X15 Y10", "G1 X15 Y9"]

        before, after = (print_trace.trace("\n".join(high + lines)) for lines in (low, low + beside))
        self.assertEqual(list(checks.obstacles(before, after, None)), [])

    def test_travel_through_a_tower_is_found(self):
        tower = HEAD + [line for n in range(1, 20) for line in layer(n * 0.2, block(20, n * 0.2))]
        around = tower + ["G1 Z10", "G1 X0 Y0"] + layer(0.2, block(0, 0.2), ["G1 X15 Y40 F9000"], block(40, 0.2))
        through = tower + ["G1 Z10", "G1 X0 Y0"] + layer(0.2, block(0, 0.2), block(40, 0.2))

        self.assertIn("obstacles", faults(around, through))

    def test_of_a_move_to_far_away_what_lies_near_counts(self):
        tower = [line for n in range(1, 20) for line in layer(n * 0.2, block(20, n * 0.2))]
        moves = print_trace.trace("\n".join(HEAD + tower + ["G1 X25 Y15", "G1 X1000000 Y15", "G1 Y1000000"])).moves
        to, on = (list(checks.cells_of(move, 0.5)) for move in moves[-2:])

        self.assertIn((50, 30), to)
        self.assertLess(len(to), 50_000)
        self.assertEqual(on, [])

    def test_a_share_far_from_its_time_is_found(self):
        def told(at):
            return self.towers[:at] + ["M73 P50"] + self.towers[at:]

        self.assertEqual(faults(told(len(self.towers) // 2 + 2), told(len(self.towers) // 2 + 3)), set())
        self.assertIn("progress", faults(told(len(self.towers) // 2 + 2), told(len(HEAD) + 2)))

    def test_skin_upon_ironing_is_found(self):
        ironing = block(10, 0.2, e=0.02)
        before = HEAD + layer(0.2, block(10, 0.2), ironing)
        after = HEAD + layer(0.2, ironing, block(10, 0.2))

        self.assertIn("ironing", faults(before, after))

    def test_ironing_beside_the_skin_spoils_none(self):
        edge = ["G1 X12 Y10.19 F9000", "G1 F1200", "G1 X18 Y9.3 E0.012"]
        skin, ironing = block(10, 0.2), block(10, 0.2, e=0.02)
        before = HEAD + layer(0.2, skin, edge, ironing)

        self.assertEqual(faults(before, HEAD + layer(0.2, skin, ironing, edge)), set())

    def test_the_filling_of_a_narrow_gap_is_no_ironing(self):
        gap = ["G1 X12 Y10 F9000", "G1 F1200", "G1 X15 Y10 E0.004", "G1 X18 Y10.1 E0.004"]
        before = HEAD + layer(0.2, block(10, 0.2), gap)
        after = HEAD + layer(0.2, gap, block(10, 0.2))

        self.assertEqual(checks.ironing_of(print_trace.trace("\n".join(before))), set())
        self.assertNotIn("ironing", faults(before, after))

    def test_a_path_outside_its_object_is_found(self):
        def labelled(inside, outside):
            return HEAD + layer(0.2, ["M486 S0"], inside, ["M486 S-1"], outside)

        self.assertIn("deposits", faults(labelled(block(10, 0.2), block(40, 0.2)), labelled(block(40, 0.2), block(10, 0.2))))

    def test_a_lost_end_of_an_object_is_found(self):
        before = HEAD + layer(0.2, ["M486 S0"], block(10, 0.2), ["M486 S-1"])

        self.assertIn("labels", faults(before, [line for line in before if line != "M486 S-1"]))

    def test_another_end_script_is_found(self):
        self.assertIn("tail", faults(self.towers + ["M84"], self.towers))

    def test_open_travel_over_a_wall_is_found(self):
        walls = [";TYPE:External perimeter"] + block(10, 0.2) + block(40, 0.2)
        before = HEAD + layer(0.2, walls)
        after = HEAD + layer(0.2, walls, [f"G1 X{x} Y15 F9000" for x in (5, 55, 5, 55, 5)])

        self.assertIn("stringing", faults(before, after))


    def test_open_travel_along_a_wall_is_not_upon_it(self):
        walls = [";TYPE:External perimeter"] + block(10, 0.2) + block(40, 0.2)
        before = HEAD + layer(0.2, walls)

        for beside, found in ((0.3, False), (0.1, True)):
            along = [f"G1 X45 Y{10 + beside} F9000", f"G1 X48 Y{10 + beside}", f"G1 X41.5 Y{10 + beside}"]
            self.assertEqual("stringing" in faults(before, HEAD + layer(0.2, walls, along)), found)

    def test_open_travel_may_leave_its_wall_at_a_small_angle(self):
        walls = [";TYPE:External perimeter"] + block(10, 0.2)
        before = HEAD + layer(0.2, walls)

        for to, found in (("X20 Y11.5", False), ("X20 Y10.1", True), ("X5 Y15", False), ("X25 Y11.5", True)):
            self.assertEqual("stringing" in faults(before, HEAD + layer(0.2, walls, [f"G1 {to} F9000"])), found, to)

    def test_open_travel_may_leave_the_end_of_a_loop_beside_its_first_side(self):
        walls = [";TYPE:External perimeter"] + block(10, 0.2)[:-1] + ["G1 X10 Y10.06 E.3"]
        before = HEAD + layer(0.2, walls)

        for to, found in (("X15.5 Y10.45", False), ("X15.5 Y10.06", True), ("X15.5 Y9.99", True)):
            self.assertEqual("stringing" in faults(before, HEAD + layer(0.2, walls, [f"G1 {to} F9000"])), found, to)

    def test_open_travel_may_leave_a_loop_along_its_corner(self):
        corners = [(11, 10), (12, 9.86), (20, 5), (10, 0), (10, 10)]
        loop = ["G1 X10 Y10 F9000", "G1 F1800"] + [f"G1 X{x} Y{y} E.3" for x, y in corners]
        walls = [";TYPE:External perimeter"] + loop
        before = HEAD + layer(0.2, walls)

        for to, found in (("X24 Y11.2", False), ("X24 Y8", True)):
            self.assertEqual("stringing" in faults(before, HEAD + layer(0.2, walls, [f"G1 {to} F9000"])), found, to)

    def test_open_travel_to_a_layer_shows_upon_the_walls_of_that(self):
        def print_with(travel, corners):
            walls = [";TYPE:External perimeter"] + block(10, 0.2)
            return HEAD + layer(0.2, walls) + layer(0.4, travel, [f"G1 X{x} Y{y} E.3" for x, y in corners])

        around = [f"G1 X{x} Y{y} F9000" for x, y in ((10, 4), (25, 4), (25, 12))]
        across = ["G1 X25 Y12 F9000"]
        wide = [(30, 3), (30, 25), (5, 25), (5, 3), (30, 3)]
        two = [(30, 12), (30, 25), (25, 25), (25, 12), (12, 5), (12, 25), (10, 25)]

        for corners, found in ((wide, False), (two, True)):
            before, after = print_with(around, corners), print_with(across, corners)
            self.assertEqual("stringing" in faults(before, after), found, corners)

    def test_open_travel_over_a_surface_is_found_and_over_supports_is_not(self):
        for feature, found in (("Top solid infill", True), ("Support material", False)):
            lines = [f";TYPE:{feature}"]
            for y in range(10, 30):
                begin, end = (10, 40) if y % 2 == 0 else (40, 10)
                lines += [f"G1 X{begin} Y{y / 2} F9000", "G1 F1800", f"G1 X{end} Y{y / 2} E.9"]
            before = HEAD + layer(0.2, ["G1 E-.8 F2100", "G1 X10 Y5 F9000", "G1 E.8"] + lines)
            across = ["G1 X11 Y6 F9000", "G1 X39 Y14", "G1 X40 Y14.5"]

            self.assertEqual("stringing" in faults(before, before + across, "free"), found, feature)

    def test_a_gap_may_go_to_lines_of_another_width(self):
        def loop(order, cut):
            """A square whose sides have widths in turn, begun at side order[0] and ended `cut` mm early."""
            corners = [(10, 10), (20, 10), (20, 20), (10, 20)]
            lines = [f"G1 X{corners[order[0]][0]} Y{corners[order[0]][1]} F9000", "G1 F1800"]
            for side in order:
                (x0, y0), (x1, y1) = corners[side], corners[(side + 1) % 4]
                mm = 10 - (cut if side == order[-1] else 0)
                x, y = x0 + (x1 - x0) / 10 * mm, y0 + (y1 - y0) / 10 * mm
                lines += [f";WIDTH:0.4{side}", f"G1 X{x:.3f} Y{y:.3f} E{0.035 * mm:.5f}"]
            return lines

        before = HEAD + layer(0.2, loop((0, 1, 2, 3), 0.1))

        self.assertEqual(faults(before, HEAD + layer(0.2, loop((2, 3, 0, 1), 0.1)), "free"), set())
        self.assertIn("deposits", faults(before, HEAD + layer(0.2, loop((2, 3, 0, 1), 0.0)), "free"))

    def test_a_share_is_as_true_as_the_clock(self):
        """A long travel takes more of the nominal time than of that with accelerations, as one move of many."""
        def told(at):
            first = [f"G1 X{10 + 0.2 * (i % 2)} Y{10 + 0.1 * i:.1f} E0.01" for i in range(60)]
            second = [f"G1 X{210 + 0.2 * (i % 2)} Y{10 + 0.1 * i:.1f} E0.01" for i in range(60)]
            lines = ["M204 S500", "G1 X10 Y10 Z.2 F9000", "G1 F2400", *first, "G1 X210 Y10 F24000", "G1 F2400", *second]
            return HEAD + lines[:at] + ["M73 P52"] + lines[at:]

        self.assertNotIn("progress", faults(told(63), told(65)))
        self.assertIn("progress", faults(told(63), told(90)))

    def test_a_share_stands_at_the_nearer_end_of_a_long_move(self):
        def told(at, first):
            square = ["G1 X20 Y10 E1", "G1 X20 Y30 E2", "G1 X10 Y30 E1", "G1 X10 Y80 E5"]
            lines = ["G1 X10 Y10 Z.2 F6000", "G1 F600", *first, *square]
            return HEAD + lines[:at] + ["M73 P21"] + lines[at:]

        before = told(5, ["G1 X15 Y10", "G1 X10 Y10"])  # 2 of 10 seconds
        self.assertNotIn("progress", faults(before, told(3, [])))
        self.assertIn("progress", faults(before, told(5, [])))

    def test_any_message_of_progress_is_followed(self):
        def told(at, text):
            return self.towers[:at] + [text] + self.towers[at:]

        half = len(self.towers) // 2 + 2
        for text in ("M117 Layer 1/2", "M118 50 % done", ";TIME_ELAPSED:6", "M117 time left 6s", "M532 X50",
                     "; layer num/total_layer_count: 2/2", 'SET_DISPLAY_TEXT MSG="50 %"'):
            self.assertEqual(faults(told(half, text), told(half + 1, text)), set(), text)
            self.assertIn("progress", faults(told(half, text), told(len(HEAD) + 2, text)), text)

    def test_another_temperature_corner_speed_or_second_fan_is_found(self):
        at = len(HEAD) + 2 + 6
        for text in ("M104 S200", "M205 X8", "M106 P1 S99", "M221 S95"):
            after = self.towers[:at] + [text] + self.towers[at:]

            self.assertIn("deposits", faults(self.towers + [text], after), text)

    def test_a_lost_lift_is_found(self):
        pulled, lift, lower, pushed = "G1 E-.8 F2100", "G1 Z.6", "G1 Z.2", "G1 E.8"
        here, there = block(10, 0.2), block(40, 0.2)
        moves = [pulled, lift, there[0], lower, pushed] + there[1:] + [pulled, lift, here[0], lower, pushed] + here[1:]
        before = HEAD + layer(0.2, moves * 4)

        self.assertIn("lifts", faults(before, [line for line in before if line != lift]))

    def test_more_travel_of_a_file_without_lifts_lost_none(self):
        pulled, pushed = "G1 E-.8 F2100", "G1 E.8"
        here, there = block(10, 0.2), block(40, 0.2)
        closed = [pulled, there[0], pushed] + there[1:] + [pulled, here[0], pushed] + here[1:]
        before = HEAD + layer(0.2, (closed + there + here) * 4)

        self.assertNotIn("lifts", faults(before, HEAD + layer(0.2, closed * 8), "free"))

    def test_travel_to_the_next_layer_is_no_lift(self):
        pulled, pushed = "G1 E-.8 F2100", "G1 E.8"
        here, there = block(10, 0.2), block(40, 0.2)
        closed = [pulled, there[0], pushed] + there[1:]
        rising = [pulled, "G1 Z.4", "G1 X20 Y20 F9000"]  # then as there
        before = HEAD + layer(0.2, here, closed) + rising + layer(0.4, here, closed)
        after = HEAD + layer(0.2, here, closed) + layer(0.4, here, closed)

        low = [checks.low_travel(print_trace.trace("\n".join(lines)))[:2] for lines in (before, after)]
        self.assertEqual(low, [(2, 2), (2, 2)])

    def test_a_wipe_with_a_speed_on_each_line_is_one(self):
        wipe = ["G1 F8000", "G1 X18 Y10 E-.4", "G1 F8000", "G1 X15 Y10 E-.4", "G1 X40 Y40 F9000", "G1 E.8"]

        self.assertEqual(checks.wiped(print_trace.trace("\n".join(HEAD + layer(0.2, block(20, 0.2) + wipe)))), 1)

    def test_a_lost_wipe_is_found(self):
        wiped = block(10, 0.2) + ["G1 X15 Y10 E-.8", "G1 X40 Y40 F9000", "G1 E.8"]
        before = HEAD + layer(0.2, wiped * 4)

        self.assertIn("wipes", faults(before, [line.replace("G1 X15 Y10 E-.8", "G1 E-.8") for line in before]))

    def test_wipes_may_go_where_layers_are_left_without(self):
        plain, next_one = ["G1 E-.8 F2100"], ["G1 X40 Y40 F9000", "G1 E.8"]
        wipe = ["G1 X15 Y10 E-.8"]
        here, there = block(10, 0.2), block(20, 0.2)
        first, last = here + wipe + next_one, there + plain + next_one
        exchanged = there + plain + next_one, here + plain + next_one
        more = [layer(round(0.2 * i, 1), first, last) for i in range(1, 6)]
        less = [layer(round(0.2 * i, 1), *exchanged) for i in range(1, 6)]
        ends_wiped = [layer(round(0.2 * i, 1), last, first) for i in range(1, 6)]

        self.assertNotIn("wipes", faults(HEAD + sum(more, []), HEAD + sum(less, [])))
        self.assertIn("wipes", faults(HEAD + sum(ends_wiped, []), HEAD + sum(less, [])))

    def test_words_without_a_reason_are_found(self):
        held = "nothing to gain, the G-code stays unchanged: travel 1.00 -> 1.00 m"
        self.assertEqual(list(judge.reasons(held + "\n12 paths in 3 layers stay beside commands")), [])
        for says in (held, held + "\n3 layers left, because made_of_parts", held + "\ngap      0.0 % to a bound\nwords"):
            self.assertEqual(len(list(judge.reasons(says))), 1, says)


class Shrink(unittest.TestCase):
    def test_the_smallest_part_still_fails(self):
        text = "\n".join(Checks.towers) + "\n"

        small = shrink.shrink(text, lambda part: "X50 Y10 E0.3" in part)

        self.assertIn("X50 Y10 E0.3", small)
        self.assertLess(len(small), len(text) / 2)


class Generate(unittest.TestCase):
    def test_each_notation_is_the_same_for_its_seed_and_prints(self):
        for name in generate.NOTATIONS:
            text = generate.print_of(name, 3)

            self.assertEqual(text, generate.print_of(name, 3))
            self.assertGreater(len(print_trace.trace(text).deposits()), 20, name)


class Variants(unittest.TestCase):
    def test_they_deposit_the_same(self):
        towers = Checks.towers[:-1] + ["G1 E-1 F2100", "G1 X70 Y10 F9000", "G1 E1 F2100"] + block(70, 0.4)
        before = print_trace.trace("\n".join(towers))
        options = judge.Options("safe", 10.0, 0.131)
        names = set()
        for name, lines in vary.variants(towers):
            after = print_trace.trace("\n".join(lines))
            names.add(name)
            self.assertNotEqual(lines, towers, name)
            self.assertEqual(list(checks.deposits(before, after, options)), [], name)
        self.assertTrue({"e_absolute", "inches", "park_retracted_at_rises", "waits"} <= names)


if __name__ == "__main__":
    unittest.main()
