"""The shape of a report, written after report.md (schema insym.report/1): keys, their order, types and ranges."""
import json
import math

TOP = ["schema", "generator", "status", "input", "options", "points", "labels", "entities", "cycles", "symmetries",
       "group", "stats", "timing", "diagnostics"]
SYMMETRY = ["id", "type", "order", "isometry", "cycles", "tolerance", "deviation", "coverage", "fixed_points",
            "missing", "significance", "maximal", "implied_by"]


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def check_keys(value, keys):
    assert isinstance(value, dict) and list(value) == keys, f"{list(value)} should be {keys}"


def check_vector(value, dimension):
    assert isinstance(value, list) and len(value) == dimension and all(map(is_number, value)), value


def check_indices(value, n):
    assert all(isinstance(i, int) and 0 <= i < n for i in value) and len(set(value)) == len(value), value


def check_tolerance(value):
    check_keys(value, ["min", "max"])
    assert is_number(value["min"]) and (value["max"] is None or value["max"] >= value["min"]), value


def check_isometry(value, dimension):
    check_keys(value, ["matrix", "angle_deg", "step", "axis", "plane", "center"])
    assert len(value["matrix"]) == dimension + 1
    for row in value["matrix"]:
        check_vector(row, dimension + 1)
    assert value["matrix"][-1] == [0] * dimension + [1]
    assert is_number(value["angle_deg"]) and is_number(value["step"])
    for name, direction in (("axis", "direction"), ("plane", "normal")):
        if value[name] is not None:
            check_keys(value[name], ["point", direction])
            check_vector(value[name]["point"], dimension)
            check_vector(value[name][direction], dimension)
    if value["center"] is not None:
        check_vector(value["center"], dimension)


def check_symmetry(value, n, dimension):
    check_keys(value, SYMMETRY)
    assert value["type"] in list("MICTZSW") and (value["order"] is None or value["order"] >= 2)
    check_isometry(value["isometry"], dimension)
    for cycle in value["cycles"]:
        check_keys(cycle, ["points", "closed"])
        check_indices(cycle["points"], n)
        assert isinstance(cycle["closed"], bool)
    check_tolerance(value["tolerance"])
    check_keys(value["deviation"], ["rms", "max"])
    assert 0 <= value["deviation"]["rms"] <= value["deviation"]["max"] * (1 + 1e-12)
    assert 0 <= value["coverage"] <= 1 and is_number(value["significance"])
    check_indices(value["fixed_points"], n)
    for slot in value["missing"]:
        check_keys(slot, ["position"])
        check_vector(slot["position"], dimension)
    assert isinstance(value["maximal"], bool) and all(isinstance(i, int) for i in value["implied_by"])


def check_entity(entity):
    """What the schema asks for first, then what is known, in this order."""
    optional = ["ids", "role", "radius", "minor_radius", "length", "area", "part"]
    check_keys(entity, ["kind", "id", "geometry"] + [key for key in optional if key in entity])
    assert entity["kind"] in ("vertex", "edge", "face") and entity["geometry"]
    assert entity["id"] == min(entity.get("ids", [entity["id"]])) >= 1
    assert entity.get("role", "hole") in ("hole", "boss", "hollow", "round")
    assert all(entity[key] >= 0 for key in optional[2:6] if key in entity)


def check_report(report):
    check_keys(report, TOP)
    assert report["schema"] == "insym.report/1"
    check_keys(report["generator"], ["name", "version"])
    assert report["status"] in ("complete", "time_limit", "cancelled", "result_limit")
    check_keys(report["input"], ["path", "format", "unit", "dimension", "diameter", "merged_points"])
    check_keys(report["options"], ["method", "types", "resolution", "max_tolerance", "points"])
    n, dimension = len(report["points"]), report["input"]["dimension"]
    assert dimension in (2, 3)
    for point in report["points"]:
        check_vector(point, dimension)
    for name in ("labels", "entities"):
        assert report[name] is None or len(report[name]) == n
    for entity in report["entities"] or []:
        check_entity(entity)
    for cycle in report["cycles"]:
        check_keys(cycle, ["points", "closed", "types", "tolerance"])
        check_indices(cycle["points"], n)
        check_tolerance(cycle["tolerance"])
    for symmetry in report["symmetries"]:
        check_symmetry(symmetry, n, dimension)
    ids = [s["id"] for s in report["symmetries"]]
    assert len(set(ids)) == len(ids) and all(set(s["implied_by"]) <= set(ids) for s in report["symmetries"])
    assert (report["group"] is None) == (report["options"]["method"] == "paper")
    if report["group"] is not None:
        check_keys(report["group"], ["schoenflies", "hermann_mauguin", "center", "empty_slots"])
        check_vector(report["group"]["center"], dimension)
    check_keys(report["stats"], ["seeds", "cycles", "symmetries"])
    check_keys(report["timing"], ["load_s", "cycles_s", "symmetries_s", "detect_s"])
    assert all(value >= 0 for value in report["timing"].values())
    for diagnostic in report["diagnostics"]:
        check_keys(diagnostic, ["code", "message"])


def checked_report(data):
    report = json.loads(data.decode("utf-8"))
    check_report(report)
    return report
