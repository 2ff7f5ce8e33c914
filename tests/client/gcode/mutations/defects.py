"""Defects to put into a good file: one change each that a print must not suffer.

Each takes (file, rng) and returns the changed text, or None if the file has no place for it. The
tables name the rule that is there for it.
"""

import deposit_defects
import filament_defects
import lift_defects
import order_defects
import path_defects
import retraction_defects
import script_defects
import setting_defects
import speed_defects
import state_defects
import text_defects
import travel_defects
import wipe_defects

DEFECTS = (order_defects.DEFECTS + deposit_defects.DEFECTS + path_defects.DEFECTS + retraction_defects.DEFECTS +
           filament_defects.DEFECTS + wipe_defects.DEFECTS + lift_defects.DEFECTS + travel_defects.DEFECTS +
           speed_defects.DEFECTS + script_defects.DEFECTS + setting_defects.DEFECTS + state_defects.DEFECTS +
           text_defects.DEFECTS)
