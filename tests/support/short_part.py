"""The first layer of the bundled sample, for what does not have to happen amid long work."""
import pathlib

SAMPLE = pathlib.Path(__file__).resolve().parents[2] / "deploy/samples/clusters13.gcode"


def write(path):
    text = SAMPLE.read_text(encoding="utf-8")
    head, layer = text.split(";LAYER_CHANGE")[:2]
    settings = text[text.rindex("\n; prusaslicer_config = begin"):]
    path.write_text(head + ";LAYER_CHANGE" + layer + settings, encoding="utf-8")
