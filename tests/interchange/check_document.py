# Every field that a block of MATLAB names is in the file it speaks of, and results are those of steps.csv: check_document.py DOCUMENT KIND=JSON... RUN
import csv, json, re, sys

document, run = open(sys.argv[1], encoding="utf-8").read(), sys.argv[-1]
files = {kind: json.load(open(name, encoding="utf-8")) for kind, name in (arg.split("=") for arg in sys.argv[2:-1])}
failures = count = 0


def look(value, path):
    for name in path:
        value = value[0] if isinstance(value, list) else value
        value = value[name]
    return value


for kind, block in re.findall(r"<!-- (\w+) -->\n```matlab\n(.*?)```", document, re.S):
    known = {"S": files[kind]}
    for line in block.splitlines():
        code = line.split("%")[0]
        assigned = re.match(r"(\w+) = (\w+)((?:\.\w+)+)(\{\d+\})?;", code)
        for name, path in re.findall(r"\b([A-Z])((?:\.[a-zA-Z]\w*)+)", re.sub(r"\(\d+\)", "", line)):
            count += 1
            try:
                value = look(known[name], path[1:].split("."))
            except (KeyError, IndexError, TypeError):
                print("no field %s%s: %s" % (name, path, line))
                failures += 1
                continue
            if assigned and (name, path) == (assigned[2], assigned[3]):
                known[assigned[1]] = value[int(assigned[4][1:-1]) - 1] if assigned[4] else value
if count < 15:
    print("only %d fields in the blocks" % count)
    failures += 1

# the numbers are those of the other files of the run
results = files["results"]["results"]
steps = {}
for row in csv.DictReader(open(run + "/steps.csv", encoding="utf-8")):
    steps.setdefault(row["pipeline"], []).append(row)
for pipeline in results.values():
    rows = steps[pipeline["name"]]
    for i in (1, 2):
        for bound in ("lower", "upper"):
            same = pipeline[bound][i - 1] == [float(row["%s_%d" % (bound, i)]) for row in rows]
            failures += not same
            if not same:
                print("%s: %s_%d is not that of steps.csv" % (pipeline["name"], bound, i))
    failures += pipeline["metrics"]["radius"][0] != [float(row["radius"]) for row in rows]
    failures += pipeline["consistent"][0] != [{"yes": 1, "no": 0}.get(row["consistent"], "nan") for row in rows]
sets = [json.loads(line) for line in open(run + "/sets.jsonl", encoding="utf-8")]
for pipeline in results.values():
    own = [line for line in sets if line["pipeline"] == pipeline["name"]]
    for line, value in zip(own, pipeline["sets"], strict=True):
        failures += line["G"] != value["G"] or line["A"] != value["A"] or [[x] for x in line["c"]] != value["c"]
data = files["results"]["data"]
failures += len(data["k"][0]) != 101 or len(data["x"]) != 2
sys.exit(failures > 0)
