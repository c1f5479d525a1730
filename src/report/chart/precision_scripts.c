/* The scripts as text, with names escaped for each language. */
#include "precision_scripts.h"

#include <math.h>

#include "app/text/escape.h"

corot_status precision_gnuplot(const void *what, FILE *out) {
  const precision_script *s = what;
  const study_table *t = s->table;
  int error = s->error;
  char label[160];
  fputs(
      "# Draws the diagram with gnuplot, in the folder of this file:\n"
      "#   gnuplot -e \"output='figure.svg'\" FILE\n"
      "if (!exists('output')) output = ",
      out);
  escape_gnuplot(s->name, out);
  fputs(".'-gnuplot.svg'\ncsv = ", out);
  escape_gnuplot(s->name, out);
  fputs(
      ".'.csv'\n"
      "set terminal svg size 720,560 font 'sans,13' background 'white' noenhanced\n"
      "set output output\n"
      "set datafile separator comma\n"
      "set logscale xy\n"
      "set format '%h'\n"
      "set grid\n"
      "set key below maxcols 3\n"
      "set title ",
      out);
  escape_gnuplot(t->title, out);
  fputs("\nset xlabel ", out);
  escape_gnuplot(study_cost_label[s->cost], out);
  study_error_label(t->error_name[error], sizeof label, label);
  fputs("\nset ylabel ", out);
  escape_gnuplot(label, out);
  fputs("\nrated(series, x) = $1 == series && strcol(6) eq 'rated' ? x : NaN\n", out);
  if (isfinite(study_floor(t, error))) fprintf(out, "floor = %.17g\n", study_floor(t, error));
  fputs("plot \\\n", out);
  for (int k = 0; k < t->nseries; k++) {
    fprintf(out, "  csv using (rated(%d, $4)):5 with linespoints title ", k);
    escape_gnuplot(t->series[k], out);
    fputs(k + 1 < t->nseries ? ", \\\n" : "", out);
  }
  if (isfinite(study_floor(t, error)))
    fprintf(out, "%s  floor with lines lt 0 lw 2 title 'floor'", t->nseries ? ", \\\n" : "");
  fputc('\n', out);
  return COROT_OK;
}

corot_status precision_matplotlib(const void *what, FILE *out) {
  const precision_script *s = what;
  const study_table *t = s->table;
  char label[160];
  double floor = study_floor(t, s->error);
  fputs(
      "\"\"\"Draws the diagram with matplotlib: python3 FILE [FIGURE.pdf]\"\"\"\n"
      "import csv\nimport pathlib\nimport sys\n\n"
      "import matplotlib\nmatplotlib.use(\"Agg\")\nimport matplotlib.pyplot as plt\n\n"
      "here = pathlib.Path(__file__).parent\nname = ",
      out);
  escape_python(s->name, out);
  fputs(
      "\nseries = {}\n"
      "with open(here / (name + \".csv\"), newline=\"\") as table:\n"
      "    for row in csv.DictReader(table):\n"
      "        x, y = series.setdefault(row[\"series\"], ([], []))\n"
      "        if row[\"status\"] == \"rated\":\n"
      "            x.append(float(row[\"",
      out);
  fputs(study_cost_word[s->cost], out);
  fputs(
      "\"] or \"nan\"))\n"
      "            y.append(float(row[\"error\"] or \"nan\"))\n\n"
      "figure, axes = plt.subplots(figsize=(7, 5.5), layout=\"constrained\")\n"
      "markers = \"os^Dv*PX\"\n"
      "for k, (label, (x, y)) in enumerate(series.items()):\n"
      "    axes.loglog(x, y, marker=markers[k % len(markers)], label=label)\n",
      out);
  if (isfinite(floor))
    fprintf(out, "axes.axhline(%.17g, color=\"gray\", linestyle=\"dashed\", label=\"floor\")\n",
            floor);
  fputs("axes.set_title(", out);
  escape_python(t->title, out);
  fputs(")\naxes.set_xlabel(", out);
  escape_python(study_cost_label[s->cost], out);
  study_error_label(t->error_name[s->error], sizeof label, label);
  fputs(")\naxes.set_ylabel(", out);
  escape_python(label, out);
  fputs(
      ")\naxes.grid(True, which=\"both\", alpha=0.3)\naxes.legend(fontsize=\"small\")\n"
      "figure.savefig(sys.argv[1] if len(sys.argv) > 1 else here / (name + \"-matplotlib.pdf\"))\n",
      out);
  return COROT_OK;
}
