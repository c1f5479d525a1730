"""Who is on the front: the least CPU time within 1 % and within 0.1 %."""
from problems import PROBLEMS

LEVELS = [0.01, 0.001]


def earned(rows):
    """For each row its error, or that of a finer mesh of the same family where it is larger: what
    a single row is better by is chance, where an error changes its sign."""
    rows, families = [row for row in rows if "error" in row], {}
    for row in rows:
        families.setdefault((row["problem"], row["peer"], row["row"]), []).append(row)
    return [dict(row, earned=max(
        other["error"] for other in families[row["problem"], row["peer"], row["row"]]
        if other["unknowns"] >= row["unknowns"])) for row in rows]


def least(rows, problem, peer, level):
    """The cheapest row within a level; None: there is none."""
    there = [r for r in rows if r["problem"] == problem and r["peer"] == peer
             and r["earned"] <= level]
    return min(there, key=lambda r: r["cpu_s"], default=None)


def ranking(rows, problem, peers, level):
    """(peer, row) by rank."""
    found = [(peer, least(rows, problem, peer, level)) for peer in peers]
    return sorted([f for f in found if f[1]], key=lambda f: f[1]["cpu_s"])


def undecided(problem, level):
    """Whether the truth is not known well enough for a level."""
    value, known_to = PROBLEMS[problem]["truth"]
    return known_to > level * abs(value)


def table(rows, peers, problems):
    """As Markdown. Where the truth is not known to the level, nobody is first."""
    rows, lines, fronts = earned(rows), [], {}
    for level in LEVELS:
        lines += [f"CPU seconds to {100 * level:g} %:", "",
                  "| problem | " + " | ".join(peers) + " | the cheapest |",
                  "|---" * (len(peers) + 2) + "|"]
        for problem in problems:
            order = ranking(rows, problem, peers, level)
            cost = {peer: f"{row['cpu_s']:.3f}" for peer, row in order}
            if undecided(problem, level):
                what = "not decided: the truth is not known so well"
            elif order:
                first, best = order[0]
                cost[first] = f"**{cost[first]}**"
                fronts[first, level] = fronts.get((first, level), 0) + 1
                what = f"{first}: {best['row']}, {best['mesh']}"
            else:
                what = "none in the time"
            cells = [PROBLEMS[problem]["title"]] + [cost.get(p, "-") for p in peers] + [what]
            lines.append("| " + " | ".join(cells) + " |")
        lines.append("")
    for level in LEVELS:
        count = ", ".join(f"{p} {fronts.get((p, level), 0)}" for p in peers)
        lines.append(f"First at {100 * level:g} %, of {len(problems)}: {count}.")
    return "\n".join(lines) + "\n"
