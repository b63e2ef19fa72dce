"""Holds what `talus profile` writes against its --json. check_profile.py page|trace|csv|why JSON FILE..."""
import csv
import html.parser
import json
import re
import sys

KINDS = ("mean", "p50", "p95", "p99", "p999", "max")


def fail(text):
    print("    " + text)
    sys.exit(1)


class Texts(html.parser.HTMLParser):
    """The text of every element with an id, and the cells of every table with one, row by row."""

    def __init__(self):
        super().__init__()
        self.open, self.by_id, self.tables, self.charts = [], {}, {}, []

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if tag in ("meta", "input", "br"):
            return
        self.open.append((tag, attributes.get("id")))
        table = self.table()
        if tag == "tr" and table is not None:
            self.tables.setdefault(table, []).append([])
        if tag in ("td", "th") and table is not None:
            self.tables[table][-1].append("")
        if tag in ("path", "rect", "line"):
            self.charts.append((tag, attributes))

    def handle_endtag(self, tag):
        while self.open and self.open.pop()[0] != tag:
            pass

    def table(self):
        for tag, name in reversed(self.open):
            if tag == "table":
                return name
        return None

    def handle_data(self, text):
        for _, name in self.open:
            if name is not None:
                self.by_id[name] = self.by_id.get(name, "") + text
        if self.open and self.table() is not None and any(tag in ("td", "th") for tag, _ in self.open):
            self.tables[self.table()][-1][-1] += text


def same(name, shown, number):
    # Both are rounded, from the same nanoseconds; the sum of a mean may be taken in another order.
    if shown is None or abs(float(shown) - number) > 0.51e-4 + 1e-9 * abs(number):
        fail(f"{name}: the page has {shown!r}, the JSON {number!r}")


def check_page(data, dom, log):
    console = [line for line in open(log, errors="replace") if "CONSOLE" in line]
    if console:
        fail("the page's scripts complain: " + console[0].strip())
    page = Texts()
    page.feed(open(dom, encoding="utf-8").read())
    for kind in KINDS:
        same("figure-" + kind, page.by_id.get("figure-" + kind), data["ms"][kind])
        for stage in data["stages"]:
            name = f"stage-{stage['name']}-{kind}"
            same(name, page.by_id.get(name), stage[kind])
    if "budget_ms" in data and page.by_id.get("figure-over") != str(len(data["over"])):
        fail(f"figure-over: {page.by_id.get('figure-over')!r}, not {len(data['over'])}")
    shown = [row for row in page.tables.get("worst", [])[1:]]
    wanted = [[str(w["step"]), "%.4f" % (w["ns"] * 1e-6), w["why"]] for w in data["worst"]]
    if shown != wanted:
        fail("the table of the worst steps differs")
    worst = data["worst"][0]
    if not page.by_id["picked-title"].startswith(f"Step {worst['step']}:"):
        fail("the worst step is not the one picked")
    held = {row[0]: row[1] for row in page.tables["picked-counts"][1:]}
    counts = data["frames"][worst["step"] - 1]["counts"]
    for name, value in zip(data["counts"], counts):
        if value and held.get(name.replace("_", " ")) != str(value):
            fail(f"what the worst step held: {name} is {held.get(name)!r}, not {value}")
    paths = [a for tag, a in page.charts if tag == "path" and a.get("d")]
    bars = sum(a["d"].count("M") for a in paths if a.get("class", "").startswith("bar"))
    if bars != min(len(data["frames"]), 1000):
        fail(f"the timeline has {bars} bars of {len(data['frames'])} steps")
    if any("NaN" in str(a) or "undefined" in str(a) for _, a in page.charts):
        fail("a chart has what is not a number in it")


def check_trace(data, path):
    trace = json.load(open(path))
    frames = end = 0
    counters = set()
    for event in trace["traceEvents"]:
        kind = event["ph"]
        if not isinstance(event["name"], str) or kind not in ("X", "C", "M") or event["pid"] != 1:
            fail(f"no event of the format: {event}")
        if kind == "M":
            if event["name"] not in ("process_name", "thread_name") or not isinstance(event["args"]["name"], str):
                fail(f"no metadata of the format: {event}")
            continue
        if not isinstance(event["ts"], (int, float)):
            fail(f"no time: {event}")
        if kind == "C":
            counters.add(event["name"])
            if not event["args"] or not all(isinstance(v, int) for v in event["args"].values()):
                fail(f"no counter of the format: {event}")
        elif event["cat"] == "frame":
            frame = data["frames"][frames]
            if event["ts"] < end - 1e-6 or abs(event["dur"] - frame["ns"] * 1e-3) > 1e-6:
                fail(f"frame {frames + 1}: {event}")
            end = event["ts"] + event["dur"]
            frames += 1
        elif event["tid"] != 1 or event["dur"] < 0 or event["ts"] + event["dur"] > end + 1e-6:
            fail(f"a stage beyond its frame: {event}")
    if frames != len(data["frames"]) or not {"bodies", "pairs", "islands"} <= counters:
        fail(f"{frames} frames and the counters {sorted(counters)}")


def check_csv(data, path):
    rows = list(csv.DictReader(open(path)))
    if len(rows) != len(data["frames"]):
        fail(f"{len(rows)} rows of {len(data['frames'])} steps")
    for i, (row, frame) in enumerate(zip(rows, data["frames"])):
        wanted = {"step": i + 1, "ns": frame["ns"]}
        wanted.update(zip((s["name"] + "_ns" for s in data["stages"]), frame["stages"]))
        wanted.update(zip(data["counts"], frame["counts"]))
        if {k: int(v) for k, v in row.items()} != wanted:
            fail(f"row {i + 1} differs")


def check_why(data):
    worst = data["worst"][0]
    frame = data["frames"][worst["step"] - 1]
    if frame["ns"] != max(f["ns"] for f in data["frames"]):
        fail("the worst step is not the longest")
    # "narrow 2.600 ms (median 0.600) for 412 manifolds computed (35)": a stage, and a count above the median's
    if not re.match(r"[a-z]+ [0-9.]+ ms \(median [0-9.]+\) for [0-9]+ [a-z ]+ \([0-9]+\)", worst["why"]):
        fail("the worst step is not explained: " + worst["why"])


def main():
    data = json.load(open(sys.argv[2]))
    {"page": check_page, "trace": check_trace, "csv": check_csv, "why": check_why}[sys.argv[1]](data, *sys.argv[3:])


main()
