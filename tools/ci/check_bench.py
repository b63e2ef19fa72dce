"""Holds the JSON of `talus bench` against what must be so whatever the machine. check_bench.py WHAT JSON"""
import json
import math
import sys

ERRORS = ("overlap_p99_m", "overlap_most_m", "joints_apart_m", "drift_m", "energy_gained_m")


def fail(text):
    print("    " + text)
    sys.exit(1)


def positive(row, *names):
    for name in names:
        if not (isinstance(row[name], (int, float)) and math.isfinite(row[name]) and row[name] > 0):
            fail(f"{name} is {row[name]!r}: {row}")


def check_queries(data):
    if len({row["method"] for row in data["rows"]}) < 7:
        fail("methods are missing")
    for row in data["rows"]:
        positive(row, "ns", "ns_median", "queries")
        if not 0 <= row["error_mean"] <= row["error_most"]:
            fail(f"errors out of order: {row}")
    for row in data["world"]["rows"]:
        positive(row, "ns", "ns_median", "found")
        if row["wrong"] or not 0 <= row["error_most_m"] <= 5e-3:
            fail(f"a world answers otherwise than its shapes: {row}")


def check_solver(data):
    if len(data["scenes"]) < 10:
        fail("scenes are missing")
    for scene in data["scenes"]:
        if len({row["setting"] for row in scene["rows"]}) != len(scene["rows"]) or len(scene["rows"]) < 4:
            fail(f"{scene['scene']}: settings are missing or there twice")
        for row in scene["rows"]:
            positive(row, "ms", "ms_median", "substeps", "iterations", "contact_hertz")
            errors = [row[name] for name in ERRORS]
            if any(e is not None and not (math.isfinite(e) and e >= 0) for e in errors):
                fail(f"{scene['scene']}: an error is none: {row}")
            if row["overlap_p99_m"] > row["overlap_most_m"] or (errors[2] is None) != (scene["joints"] == 0):
                fail(f"{scene['scene']}: errors that cannot be: {row}")
        for name in ERRORS:
            if scene["rows"][0][name] is not None and not any(name[:-2] in row["front"] for row in scene["rows"]):
                fail(f"{scene['scene']}: nothing is on the front of {name}")


def check_features(data):
    if len({row["feature"] for row in data["rows"]}) < 10 or len(data["rows"]) % 2:
        fail("features are missing")
    for row in data["rows"]:
        positive(row, "ms_without", "ms_with", "ratio", "ratio_low", "ratio_high", "bodies")
        if not row["ratio_low"] <= row["ratio"] <= row["ratio_high"] or row["over"]:
            fail(f"a ratio out of its interval, or a verdict on one pair: {row}")


def main():
    {"queries": check_queries, "solver": check_solver, "features": check_features}[sys.argv[1]](json.load(open(sys.argv[2])))


main()
