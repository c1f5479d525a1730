"""One HTML page: a diagram of error against CPU time for each problem, and the ranks."""
import html
import math

import ranks
from problems import PROBLEMS

COLOURS = {"corot": "#1f5fa8", "calculix": "#c8571b", "getfem": "#3a8a4d", "dolfinx": "#7a4fa3"}
WIDTH, HEIGHT, LEFT, BOTTOM = 420, 280, 62, 40
STYLE = """body{font:15px/1.45 Helvetica,Arial,sans-serif;max-width:1320px;margin:2em auto;
padding:0 1em;color:#222}table{border-collapse:collapse}td,th{padding:.2em .7em;text-align:right;
border-bottom:1px solid #ddd}td:first-child,th:first-child,
td:last-child,th:last-child{text-align:left}
.first{font-weight:bold}figure{display:inline-block;margin:0 1em 1em 0}figcaption{font-size:13px}"""


def decades(values):
    return math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)) + 1e-9)


def stairs(rows):
    """The rows that nothing cheaper beats, the cheapest first."""
    front = []
    for row in sorted(rows, key=lambda r: (r["cpu_s"], r["earned"])):
        if not front or row["earned"] < front[-1]["earned"]:
            front.append(row)
    return front


def grid(x, y, spans):
    (x0, x1), (y0, y1) = spans
    for k in range(x0, x1 + 1):
        yield f'<path d="M{x(10.0 ** k):.1f} 10V{HEIGHT - BOTTOM}" stroke="#ddd"/>'
        yield (f'<text x="{x(10.0 ** k):.1f}" y="{HEIGHT - BOTTOM + 16}" '
               f'text-anchor="middle">{10.0 ** k:g}</text>')
    for k in range(y0, y1 + 1):
        level = 10.0 ** k in (0.01, 0.001)
        yield (f'<path d="M{LEFT} {y(10.0 ** k):.1f}H{WIDTH - 10}" '
               f'stroke="{"#999" if level else "#ddd"}"/>')
        yield (f'<text x="{LEFT - 6}" y="{y(10.0 ** k) + 4:.1f}" '
               f'text-anchor="end">{100 * 10.0 ** k:g} %</text>')


def diagram(rows, peers):
    """Dots: all rows; lines: of each peer those that nothing cheaper of its own beats."""
    rows = [dict(r, earned=max(r["earned"], 1e-6)) for r in rows]
    spans = decades([r["cpu_s"] for r in rows]), decades([r["earned"] for r in rows] + [1e-3, 1e-2])
    (x0, x1), (y0, y1) = spans
    x = lambda v: LEFT + (math.log10(v) - x0) / (x1 - x0) * (WIDTH - 10 - LEFT)
    y = lambda v: HEIGHT - BOTTOM - (math.log10(v) - y0) / (y1 - y0) * (HEIGHT - BOTTOM - 10)
    out = [f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" '
           'font-size="11" fill="#333">', *grid(x, y, spans)]
    for peer in peers:
        mine, colour = [r for r in rows if r["peer"] == peer], COLOURS[peer]
        path = "L".join(f"{x(r['cpu_s']):.1f} {y(r['earned']):.1f}" for r in stairs(mine))
        if path:
            out.append(f'<path d="M{path}" fill="none" stroke="{colour}" stroke-width="1.8"/>')
        for r in mine:
            note = html.escape(f"{peer}, {r['row']}, {r['mesh']}: {100 * r['error']:.3g} % in "
                               f"{r['cpu_s']:.3g} s")
            out.append(f'<circle cx="{x(r["cpu_s"]):.1f}" cy="{y(r["earned"]):.1f}" r="3" '
                       f'fill="{colour}"><title>{note}</title></circle>')
    out.append(f'<text x="{WIDTH / 2}" y="{HEIGHT - 6}" text-anchor="middle">CPU time [s]</text>')
    return "".join(out) + "</svg>"


def rank_table(rows, peers, problems, level):
    yield f"<h2>CPU seconds to {100 * level:g} %</h2><table><tr><th>problem</th>"
    yield "".join(f"<th>{p}</th>" for p in peers) + "<th>the cheapest</th></tr>"
    for problem in problems:
        order = ranks.ranking(rows, problem, peers, level)
        cost = {peer: row["cpu_s"] for peer, row in order}
        best = order[0] if order and not ranks.undecided(problem, level) else None
        yield f"<tr><td>{html.escape(PROBLEMS[problem]['title'])}</td>"
        for peer in peers:
            first = ' class="first"' if best and best[0] == peer else ""
            yield f"<td{first}>{cost[peer]:.3f}</td>" if peer in cost else "<td>-</td>"
        what = f"{best[0]}: {best[1]['row']}, {best[1]['mesh']}" if best else "-"
        yield f"<td>{html.escape(what)}</td></tr>"
    yield "</table>"


def write(path, rows, peers, problems):
    rows = ranks.earned(rows)
    key = ", ".join(f'<b style="color:{COLOURS[p]}">{p}</b>' for p in peers)
    out = ["<!DOCTYPE html><html lang=en><meta charset=utf-8><title>corot beside others</title>",
           f"<style>{STYLE}</style><h1>Error against CPU time, beside others</h1>",
           f"<p>{key}. A dot is a run; a line joins what nothing cheaper of the same program "
           "beats. An error is that of the row or, where it is larger, of a finer mesh with the "
           "same settings: where an error changes its sign, one mesh is good by chance.</p>"]
    for level in ranks.LEVELS:
        out += rank_table(rows, peers, problems, level)
    out.append("<h2>Problems</h2>")
    for problem in problems:
        there = [r for r in rows if r["problem"] == problem]
        if there:
            out.append(f"<figure><figcaption><b>{html.escape(PROBLEMS[problem]['title'])}</b>"
                       f"</figcaption>{diagram(there, peers)}</figure>")
    with open(path, "w") as file:
        file.write("\n".join(out) + "</html>\n")
