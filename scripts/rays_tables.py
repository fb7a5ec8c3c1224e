#!/usr/bin/env python3
"""Markdown tables of rays with structure from the benchmark's figures.

  raygrain-bench --suite rays --threads 1 2 --json rays.json
  scripts/rays_tables.py rays.json --into docs/performance-rays.md README.md

Prints all tables, or rewrites those that files hold between <!-- rays:NAME --> and <!-- /rays:NAME -->."""
import argparse
import json
import math
import re

SUN_ANY, LAMP_ANY = "sun_any", "point_any"
SETS = {
    SUN_ANY: "sun, any, shuffled",
    LAMP_ANY: "lamp, any, shuffled",
    "sun_closest_shuffled": "sun, closest, shuffled",
    "pinhole_closest_shuffled": "pinhole, closest, shuffled",
    "sun_closest_scan": "sun, closest, in order",
    "pinhole_closest_scan": "pinhole, closest, in order",
    "disc_any_0.27": "disc 0.27",
    "disc_any_5": "disc 5",
    "rect_any": "area light",
}
FOREIGN = {"foreign_any": "no area's, any", "foreign_closest": "no area's, closest"}
ANY = [SUN_ANY, LAMP_ANY]
CLOSEST = ["sun_closest_shuffled", "pinhole_closest_shuffled"]
IN_ORDER = ["sun_closest_scan", "pinhole_closest_scan"]
WIDE = ["disc_any_0.27", "disc_any_5", "rect_any"]
# Columns: a title, whose areas, and before the keys "area_" for the slowest or largest of its areas alone.
STRUCTURES = {"sun": ("sun", ""), "lamp": ("lamp", ""), "a frustum": ("lamp", "area_"), "camera": ("camera", "")}
NOISE = 0.03  # of a ray's time: what saves less is told apart from nothing by no run


def geometric_mean(values):
    logarithms = [math.log(v) for v in values]
    return math.exp(sum(logarithms) / len(logarithms)) if logarithms else None


class Figures:
    def __init__(self, data):
        self.about = data["environment"]
        self.rows = [r for r in data["rows"] if r["suite"] == "rays" and "turn" not in r]
        self.turned = [r for r in data["rows"] if "turn" in r]
        self.structures = data.get("area_builds", [])
        self.triangles = {r["scene"]: r["triangles"] for r in self.rows}
        self.scenes = list(self.triangles)
        self.threads = sorted({r["threads"] for r in self.rows})
        self.index = {(r["scene"], r["rays"], r["api"], r["threads"]): r for r in self.rows}

    def value(self, scene, rays, api, threads, key):
        return self.index.get((scene, rays, api, threads), {}).get(key)

    def mean(self, sets, api, threads, key, scenes=None):
        values = [self.value(s, rays, api, threads, key) for s in scenes or self.scenes for rays in sets]
        return geometric_mean(v for v in values if v)

    def structure(self, scene, name, threads):
        found = [s for s in self.structures if (s["scene"], s["structure"], s["threads"]) == (scene, name, threads)]
        return found[0] if found else None

    def label(self, scene):
        return f"{scene.split(' ')[0]} {self.triangles[scene]:,}"

    def procedural(self):
        return [s for s in self.scenes if " " in s]


def words(threads):
    return {1: "one thread", 2: "two threads"}.get(threads, f"{threads} threads")


def number(x, digits=2):
    return "-" if x is None else f"{x:.{digits}f}"


def numbers(values, digits=2):
    return "-" if all(v is None for v in values) else " / ".join(number(v, digits) for v in values)


def scene_count(scenes, kind=""):
    return f"{len(scenes)} {kind}scene" + ("" if len(scenes) == 1 else "s")


def table(head, lines, rule="---|"):
    return "\n".join(["| " + " | ".join(head) + " |", "|---|" + rule * (len(head) - 1)] +
                     ["| " + " | ".join(line) + " |" for line in lines])


def of_sets(f, api, threads, keys, keys_in_order=None):
    """A line a scene, a column a set; rays in order have their own keys."""
    def keys_of(rays):
        return keys_in_order if keys_in_order and rays in IN_ORDER else keys
    lines = [[f.label(s)] + [numbers([f.value(s, r, api, threads, k) for k in keys_of(r)]) for r in SETS]
             for s in f.scenes]
    lines.append(["**mean**"] + [numbers([f.mean([r], api, threads, k) for k in keys_of(r)]) for r in SETS])
    return table(["scene, " + words(threads)] + list(SETS.values()), lines)


def batches(f):
    return "\n\n".join(of_sets(f, "batch", n, ["ratio_best", "ratio_sorted"], ["ratio_best"]) for n in f.threads)


def singles(f):
    return "\n\n".join(of_sets(f, "single", n, ["ratio_single", "ratio_global"]) for n in f.threads)


def against_global(f):
    return "\n\n".join(of_sets(f, "batch", n, ["ratio_global"]) for n in f.threads)


def foreign(f):
    columns = [(rays, api, n) for n in f.threads for rays in FOREIGN for api in ("batch", "single")]
    head = ["scene"] + [f"{FOREIGN[rays]}, {'batch' if api == 'batch' else 'one a call'}, {words(n)}"
                        for rays, api, n in columns]
    lines = [[f.label(s)] + [number(f.value(s, *c, "ratio_global")) for c in columns] for s in f.scenes]
    lines.append(["**mean**"] + [number(f.mean([rays], api, n, "ratio_global")) for rays, api, n in columns])
    return table(head, lines)


def summary(f):
    kinds = [("one direction or point, any hit, shuffled: as given / sorted", ANY, "batch", ["best", "sorted"], "4 / 2"),
             ("... closest hit, shuffled", CLOSEST, "batch", ["best", "sorted"], "2.5 / 1.3"),
             ("... closest hit, in scanline order", IN_ORDER, "batch", ["best"], "1.0"),
             ("... one a call, any and closest", ANY + CLOSEST + IN_ORDER, "single", ["single"], "1.5"),
             ("discs and area light, batch", WIDE, "batch", ["best"], "1.5"),
             ("discs and area light, one a call", WIDE, "single", ["single"], "1.5"),
             ("rays outside every area, against the global tree: batch", list(FOREIGN), "batch", ["global"], "0.97"),
             ("... one a call", list(FOREIGN), "single", ["global"], "0.97")]
    groups = [(scene_count(f.scenes), f.scenes), (scene_count(f.procedural(), "procedural "), f.procedural())]
    columns = [(title, scenes, n) for title, scenes in groups if scenes for n in f.threads]
    lines = [[title] + [numbers([f.mean(sets, api, n, "ratio_" + k, scenes) for k in keys]) for _, scenes, n in columns] +
             [wanted] for title, sets, api, keys, wanted in kinds]
    return table(["all of a kind together (geometric means)"] + [f"{title}, {words(n)}" for title, _, n in columns] +
                 ["wanted"], lines)


def milliseconds(seconds):
    x = seconds * 1000
    return number(x, 2 if x < 10 else 1 if x < 100 else 0)


def builds(f):
    head, lines = ["scene, milliseconds"], [[f.label(s)] for s in f.scenes] + [["**mean**"]]
    for n in f.threads:
        head += [f"`best` tree, {words(n)}"] + list(STRUCTURES)
        shares = {title: [] for title in STRUCTURES}
        for scene, line in zip(f.scenes, lines):
            found = f.structure(scene, "sun", n)
            line.append(milliseconds(found["global_best_build_seconds"]) if found else "-")
            for title, (name, prefix) in STRUCTURES.items():
                s = f.structure(scene, name, n)
                if s:
                    seconds = s[prefix + "build_seconds"]
                    shares[title].append(seconds / s["global_best_build_seconds"])
                line.append(f"{milliseconds(seconds)}, {shares[title][-1]:.2f}" if s else "-")
        lines[-1] += [""] + [number(geometric_mean(v)) for v in shares.values()]
    return table(head, lines)


def memory(f):
    def cell(s, prefix):
        if not s:
            return "-"
        here, trees, wide = (s[k + "memory_bytes"] / 2**20 for k in (prefix, "global_", "global_wide_"))
        return f"{here:.1f}, {here / trees:.2f} ({here / wide:.2f})"
    lines = []
    for scene in f.scenes:
        s = f.structure(scene, "sun", f.threads[0])
        trees = f"{s['global_memory_bytes'] / 2**20:.1f} ({s['global_wide_memory_bytes'] / 2**20:.1f})" if s else "-"
        lines.append([f.label(scene), trees] + [cell(f.structure(scene, name, f.threads[0]), prefix)
                                                for name, prefix in STRUCTURES.values()])
    return table(["scene, MiB", "global trees (wide alone)"] + list(STRUCTURES), lines)


def rays_text(row):
    if not row or row.get("break_even_rays") is None:
        return "-"
    if not row["ratio_global"] or row["ratio_global"] < 1 / (1 - NOISE):
        return "none"
    thousands = row["break_even_rays"] / 1000
    return f"{thousands / 1000:.1f}M" if thousands >= 9950 else f"{thousands:,.0f}k"


def break_even(f):
    def one(n):
        def cell(scene, rays):
            return " / ".join(rays_text(f.index.get((scene, rays, api, n))) for api in ("batch", "single"))
        return table(["scene, " + words(n)] + list(SETS.values()),
                     [[f.label(s)] + [cell(s, r) for r in SETS] for s in f.scenes])
    return "\n\n".join(one(n) for n in f.threads)


def spread(values):
    """Most distant from the median, and least to most, both in per cent of the median."""
    if not values:
        return "-"
    low, median, high = min(values), sorted(values)[len(values) // 2], max(values)
    return f"{max(high - median, median - low) / median * 100:.1f} %, {(high - low) / median * 100:.1f} %"


def turned(f):
    lines, left_out = [], []
    for scene in f.scenes:
        kinds = {k: [r for r in f.turned if (r["scene"], r["rays"]) == (scene, k)]
                 for k in ("turned", "again", "directions")}
        if not kinds["turned"]:
            left_out.append(f.label(scene))
            continue

        def least_to_most(kind, key, digits):
            values = [r[key] for r in kinds[kind] if r[key]]
            return f"{min(values):.{digits}f} to {max(values):.{digits}f}" if values else "-"
        lines.append([f.label(scene), least_to_most("turned", "cost", 2), least_to_most("turned", "global_cost", 0),
                      least_to_most("turned", "raygrain_mrays", 1), spread([r["raygrain_mrays"] for r in kinds["turned"]]),
                      spread([r["raygrain_mrays"] for r in kinds["again"]]), least_to_most("turned", "global_mrays", 1),
                      least_to_most("directions", "cost", 2), least_to_most("directions", "global_cost", 0),
                      least_to_most("directions", "raygrain_mrays", 1),
                      least_to_most("directions", "global_mrays", 1)])
    text = table(["scene", "cost turned", "... world's tree", "Mrays/s turned", "furthest from the median, least to most",
                  "... again", "Mrays/s turned, world's tree", "cost, directions", "... world's tree",
                  "Mrays/s, directions", "... world's tree"], lines)
    return text + (f"\n\nNot turned: {', '.join(left_out)}." if left_out else "")


def differences(f):
    runs = differ = asked = agreed = 0
    counts = {}
    for r in f.rows:
        for prefix in ("", "sorted_"):
            if r.get(prefix + "differences") is not None:
                counts[r["scene"]] = counts.get(r["scene"], 0) + r[prefix + "differences"]
                runs += 1
                differ += r[prefix + "differences"]
                asked += r.get(prefix + "oracle_asked", 0)
                agreed += r.get(prefix + "oracle_agrees", 0)
    where = ", ".join(f"{f.label(s)} {n}" for s, n in counts.items() if n)
    return (f"Answers of {runs} runs of a set were compared with Embree's: {differ} rays differ{f' ({where})' if where else ''}; "
            f"brute force was asked about {asked} and gave raygrain's answer {agreed} times.")


def about(f):
    e = f.about
    return f"{scene_count(f.scenes)}; {e['cpu']}, {e['threads']} threads; {e['compiler']}; raygrain {e['commit']}."


def readme(f):
    def cell(sets, key):
        values = [f.mean(sets, "batch", n, "ratio_" + key) for n in f.threads]
        return ", ".join(number(v, 1) for v in values)
    kinds = [("surface points to a sun, any hit", [SUN_ANY]), ("surface points to a lamp, any hit", [LAMP_ANY]),
             ("along a sun, closest hit", [CLOSEST[0]]), ("from a pinhole, closest hit", [CLOSEST[1]]),
             ("the last two in scanline order", IN_ORDER), ("to a sun's disc (0.27 and 5 degrees) or an area light, any hit", WIDE)]
    as_given = "as given: " + ", ".join(words(n) for n in f.threads)
    return table([f"rays, {scene_count(f.scenes)}", as_given, "sorted for Embree, sort counted"],
                 [[title, cell(sets, "best"), "" if sets == IN_ORDER else cell(sets, "sorted")] for title, sets in kinds],
                 "---:|")


TABLES = {"about": about, "batches": batches, "singles": singles, "summary": summary, "global": against_global,
          "foreign": foreign, "builds": builds, "memory": memory, "break-even": break_even, "turned": turned,
          "differences": differences, "readme": readme}


def rewritten(path, figures):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    found = re.findall(r"<!-- rays:([\w-]+) -->", text)
    for name in found:
        begin, end = f"<!-- rays:{name} -->", f"<!-- /rays:{name} -->"
        if name not in TABLES:
            raise SystemExit(f"{path}: no table is called {name}")
        if text.count(begin) != 1 or text.count(end) != 1 or text.index(end) < text.index(begin):
            raise SystemExit(f"{path}: {begin} and {end} must be there once, in this order")
        head, tail = text.split(begin)[0], text.split(end)[1]
        text = head + begin + "\n" + TABLES[name](figures) + "\n" + end + tail
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("figures", help="what raygrain-bench --json wrote")
    parser.add_argument("--into", nargs="+", metavar="FILE", help="files whose tables are rewritten")
    options = parser.parse_args()
    with open(options.figures, encoding="utf-8") as file:
        figures = Figures(json.load(file))
    if not any(r.get("ratio_best") for r in figures.rows) and (options.into or not figures.rows):
        raise SystemExit(f"{options.figures}: has no rows of the suite `rays` beside Embree")
    texts = [(path, rewritten(path, figures)) for path in options.into or []]  # all are good before any is written
    for path, text in texts:
        with open(path, "w", encoding="utf-8") as file:
            print(f"{path}: {file.write(text)} characters")
    if not options.into:
        for name, make in TABLES.items():
            print(f"<!-- rays:{name} -->\n{make(figures)}\n<!-- /rays:{name} -->\n")


if __name__ == "__main__":
    main()
