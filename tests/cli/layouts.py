"""The layouts of `hop export --layouts` against what viewers read and against a log:  layouts.py FOLDER LOG.mcap

Every path leads through the log's schemas to a number. The rest is what the viewers' own sources take: the settings of
Foxglove's panels (as of its last public source) and PlotJuggler's splitters, which count their children by attributes.
"""
import json
import re
import struct
import sys
import xml.etree.ElementTree as xml

NUMBER = re.compile(r"(bool|byte|char|u?int(8|16|32|64)|float(32|64))$")
PANEL_KEYS = {
    "Plot": {"foxglovePanelTitle", "paths", "showXAxisLabels", "showYAxisLabels", "showLegend", "legendDisplay",
             "showPlotValuesInLegend", "isSynced", "xAxisVal", "sidebarDimension"},
    "StateTransitions": {"foxglovePanelTitle", "paths", "isSynced"},
    "RawMessages": {"topicPath", "diffEnabled", "diffMethod", "diffTopicPath", "showFullMessageForDiff", "expansion"},
}
PATH_KEYS = {"value", "label", "enabled", "timestampMethod", "color"}


def strings(data):
    """Strings and byte arrays of an MCAP record, one after the other."""
    at = 0
    while at + 4 <= len(data):
        size, = struct.unpack_from("<I", data, at)
        yield data[at + 4:at + 4 + size]
        at += 4 + size


def topics_of(log):
    """The text of each topic's ros2msg schema."""
    data = open(log, "rb").read()
    schemas, topics, at = {}, {}, 8
    while at + 9 <= len(data) - 8:
        code, size = struct.unpack_from("<BQ", data, at)
        body = data[at + 9:at + 9 + size]
        if code == 3:
            name, _, text = list(strings(body[2:]))[:3]
            schemas[struct.unpack_from("<H", body)[0]] = (name.decode(), text.decode())
        elif code == 4:
            topics[next(strings(body[4:])).decode()] = struct.unpack_from("<H", body, 2)[0]
        at += 9 + size
    return {topic: types_of(*schemas[schema]) for topic, schema in topics.items() if schema in schemas}


def types_of(name, text):
    """Fields by name of the message ("") and of each type it uses: type, and length of an array or None."""
    types = {}
    for part in re.split(r"^=+\n", text, flags=re.M):
        own = re.match(r"MSG: (?:\w+/)?(?:msg/)?(\w+)", part)
        fields = re.findall(r"^([A-Za-z]\w*(?:/\w+)*)(?:\[(\d+)\])? ([a-z]\w*) *(?:#.*)?$", part, re.M)
        types[own[1] if own else ""] = {
            field: (kind.split("/")[-1], int(size) if size else None) for kind, size, field in fields}
    return types


def lead_to_a_number(topics, topic, steps):
    assert topic in topics, f"no topic {topic}"
    kind = ""
    for step in steps:
        name, index = re.fullmatch(r"(\w+)(?:\[(\d+|:)\])?", step).groups()
        fields = topics[topic].get(kind)
        assert fields and name in fields, f"{topic} {steps}: no field {name}"
        kind, size = fields[name]
        right = index is None if size is None else index == ":" or index is not None and int(index) < size
        assert right, f"{topic} {steps}: index of {name}"
    assert NUMBER.match(kind), f"{topic} {steps}: {kind} is no number"


def leaves(tree):
    return [tree] if isinstance(tree, str) else leaves(tree["first"]) + leaves(tree["second"])


def check_foxglove(file, topics):
    layout = json.load(open(file))
    assert {"configById", "globalVariables", "userNodes", "layout"} <= set(layout), list(layout)
    panels = layout["configById"]
    assert sorted(leaves(layout["layout"])) == sorted(panels), "panels that are placed are those that are set up"
    count = 0
    for panel, settings in panels.items():
        kind = panel.split("!")[0]
        assert set(settings) <= PANEL_KEYS[kind], f"{panel}: {set(settings) - PANEL_KEYS[kind]} is not read"
        for path in settings.get("paths", []):
            assert set(path) <= PATH_KEYS and path["timestampMethod"] in ("receiveTime", "headerStamp"), path
            topic, *steps = path["value"].split(".")
            lead_to_a_number(topics, topic, steps)
            whole = any(step.endswith("[:]") for step in steps)
            assert whole == (settings.get("xAxisVal") == "index"), f"{panel}: a whole array is drawn over its index"
            count += 1
        assert settings.get("topicPath", "/frame") in topics, settings
    return count


def check_plotjuggler(file, topics):
    root = xml.parse(file).getroot()
    assert root.tag == "root"
    tabs = root.findall("tabbed_widget/Tab")
    assert tabs and all(tab.find("Container/DockSplitter") is not None for tab in tabs)
    for splitter in root.iter("DockSplitter"):
        sizes = [float(size) for size in splitter.get("sizes").split(";")]
        assert splitter.get("orientation") in ("|", "-") and abs(sum(sizes) - 1.0) < 0.01, splitter.attrib
        assert int(splitter.get("count")) == len(sizes) == len(splitter), splitter.attrib
    for plot in root.iter("plot"):
        assert plot.get("mode") in ("TimeSeries", "XYPlot") and plot.get("style") in ("Lines", "LinesAndDots", "Dots"), plot.attrib
        for curve in plot.findall("curve"):
            crossed = plot.get("mode") == "XYPlot"
            names = [curve.get("curve_x"), curve.get("curve_y")] if crossed else [curve.get("name")]
            for name in names:
                _, topic, *steps = name.split("/")
                assert not any(step.endswith("[:]") for step in steps), f"{name}: one element a curve"
                lead_to_a_number(topics, "/" + topic, steps)
    return len(list(root.iter("curve")))


if __name__ == "__main__":
    folder, log = sys.argv[1:]
    known = topics_of(log)
    for wrong in (("/output", ["no_such_field"]), ("/output", ["estimate"]), ("/frame", ["motor", "current_a"]),
                  ("/frame", ["motor[2]", "current_a"]), ("/profile", ["force_n[56]"]), ("/ground", ["line_n_per_m"]), ("/frame", ["contact_force_n"])):
        try:
            lead_to_a_number(known, *wrong)
        except AssertionError:
            continue
        raise AssertionError(f"{wrong} is found")
    print(f"layouts: {check_foxglove(f'{folder}/sandhopper.foxglove.json', known)} paths of Foxglove's, "
          f"{check_plotjuggler(f'{folder}/sandhopper.plotjuggler.xml', known)} curves of PlotJuggler's are in the log")
