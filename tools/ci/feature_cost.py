"""Adds up what lines that speak of a feature cost, of profiles by callgrind with lines: feature_cost.py PROFILE...

A function whose name or file speaks of the feature counts whole, with what it calls, where one that does not calls it;
of the others their lines that do, with what those call. What two features share counts for both, and what two lines
call may count twice: never too little. Fails where a feature is above MOST of the step."""
import os
import re
import sys
from collections import defaultdict

MOST = 0.01
# What is looked for, and files in which the word means something else.
FEATURES = {
    "joints, linkages": (r"joint|linkage|linked", ("tree.c",)),
    "restitution": (r"bounc|strike|struck|restitution|impact", ()),
    "rolling resistance": (r"\broll|rolls|rolling", ()),
    "kinematic bodies": (r"kinematic|\bdynamic\b|(->|\.)moves\b", ()),
    "locked axes": (r"\block|_locks", ()),
    "planar bodies": (r"planar|PLANAR|in_plane|tl_plane_|contact_plane|row_planes|->plane\b|\bplanes (\?|=)|plane != ", ()),
    "sensors": (r"sensor|SENSOR|senses", ()),
    "events": (r"event|EVENT|\bhit_", ()),
    "sleep": (r"sleep|slept|asleep", ()),
    "error budget": (r"effort|budget|->parted|has_islands", ()),
    "profiler": (r"tl_watch|tl_profile|talus_clock|^watch\.h$", ()),
}


def read(path):
    """Self costs and calls by (function, its file, line's file, line): [Ir], [(called function, its file, Ir)]."""
    own, calls, total = defaultdict(int), defaultdict(list), 0
    function = file = line_file = called = called_file = None
    is_call = False
    for line in open(path, errors="replace"):
        key, _, value = line.rstrip("\n").partition("=")
        if key == "fl":
            file = line_file = value
        elif key in ("fi", "fe"):
            line_file = value
        elif key == "fn":
            function, line_file = value, file
        elif key in ("cfi", "cfl"):
            called_file = value
        elif key == "cfn":
            called, called_file = value, called_file or line_file
        elif key == "calls":
            is_call = True
        elif line.startswith(("summary:", "totals:")):
            total = int(line.split()[1])
        elif line[:1].isdigit():
            number, cost = (int(word) for word in line.split()[:2])
            where = (function, file, line_file, number)
            if is_call:
                calls[where].append((called, called_file, cost))
                is_call, called_file = False, None
            else:
                own[where] += cost
    if not total:
        sys.exit(f"{path}: callgrind counted nothing")
    return own, calls, total


class Sources:
    def __init__(self):
        self.lines = {}

    def speaks(self, pattern, path, number):
        if path not in self.lines:
            self.lines[path] = open(path, errors="replace").read().split("\n") if os.path.exists(path) else []
        lines = self.lines[path]
        return 0 < number <= len(lines) and bool(pattern.search(lines[number - 1]))


def cost_of(pattern, elsewhere, profile, sources):
    own, calls, _ = profile
    cost, lines = 0, set()

    def owned(function, file):
        return bool(pattern.search(function) or pattern.search(os.path.basename(file or "")))

    def counts(file, number):
        name = os.path.basename(file)
        return name not in elsewhere and bool(pattern.search(name) or sources.speaks(pattern, file, number))

    for (function, file, line_file, number), ir in own.items():
        if not owned(function, file) and counts(line_file, number):
            cost += ir
            lines.add((line_file, number))
    for (function, file, line_file, number), called in calls.items():
        for name, name_file, ir in called:
            if not owned(function, file) and (owned(name, name_file) or counts(line_file, number)):
                cost += ir
                lines.add((line_file, number))
    return cost, len(lines)


def main():
    sources = Sources()
    profiles = {os.path.basename(path).split(".")[0]: read(path) for path in sys.argv[1:]}
    bad = 0
    print("  share of the step's instructions, in scenes without any of it")
    print(f"  {'':20}" + "".join(f"{name:>10}" for name in profiles))
    for feature, (text, elsewhere) in FEATURES.items():
        pattern = re.compile(text)
        row = f"  {feature:20}"
        for profile in profiles.values():
            cost, lines = cost_of(pattern, elsewhere, profile, sources)
            if not lines:
                sys.exit(f"  {feature}: no line of the step speaks of it; is it called otherwise now?")
            row += f"{100 * cost / profile[2]:9.3f}%"
            bad += cost > MOST * profile[2]
        print(row)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
