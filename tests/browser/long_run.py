"""Gives the folder of a run a history of 200 000 steps, and the extremes of it, which are
peaks of a single step."""

import json
import math
import sys

N = 200000
PEAK, DIP = N // 3, 2 * N // 3  # steps

folder = sys.argv[1]
names = [f"{probe}.u{c}" for probe in ("corner", "middle") for c in "xyz"]
names += ["kinetic", "elastic", "dissipated", "external_work", "balance", "frame_energy"]
with open(folder + "/history.csv", "w") as file:
    file.write(",".join(["t", *names]) + "\n")
    for i in range(N + 1):
        value = math.sin(1e-3 * i) + (5 if i == PEAK else -7 if i == DIP else 0)
        file.write(",".join(f"{x:.9g}" for x in [i / N, *[value] * len(names)]) + "\n")

with open(folder + "/result.json") as file:
    result = json.load(file)
result["extremes"] = {name: {"min": {"value": -7 + math.sin(1e-3 * DIP), "t": DIP / N},
                             "max": {"value": 5 + math.sin(1e-3 * PEAK), "t": PEAK / N}}
                      for name in names if name not in ("balance", "frame_energy")}
result["warnings"] = [{"code": "one-thing", "text": "One <b>thing</b> is off."}, "Another is, too."]
result.pop("files")  # this history is none of them
with open(folder + "/result.json", "w") as file:
    json.dump(result, file)
