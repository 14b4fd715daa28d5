#!/usr/bin/env python3
"""Makes the parameter sets of the thesis (parameters.json, near-jamming.json, w-*.json) from tables/*.csv.

    make_parameters.py            writes them beside this script
    make_parameters.py --check    compares them with what is there; status 1 and a list if they differ

Not needed to build or to run grainlaw. docs/thesis-tables.md explains the choices.
"""
import csv
import json
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
QUANTITIES = ("s_max", "beta_s", "F_max", "beta_F")


def table(name):
    with open(HERE / "tables" / f"{name}.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def join(*texts):
    return "; ".join(text for text in texts if text)


def parameter(value, note, stderr=None, source="thesis"):
    """One entry of a parameter set. `thesis` repeats the value where the thesis gives it."""
    entry = {"value": float(value), "stderr": float(stderr) if stderr else None, "unit": "1", "source": source}
    if source == "thesis":
        entry["thesis"] = entry["value"]
    entry["note"] = note
    return entry


def cell(row, column, where, error=True):
    """A parameter from one cell; a suspect cell carries the reason along."""
    suspect = column in row["suspect"].split(";")
    note = join(where, "suspect: " + row["note"] if suspect else "")
    return parameter(row[column], note, row.get(column + "_pm") if error else None)


def constants(group):
    return {row["parameter"]: row for row in table("text-constants") if row["group"] == group and row["value"]}


def constant(group, name):
    row = constants(group)[name]
    return parameter(row["value"], join(row["where"], row["note"]), row["pm"])


def material(w):
    given = {row["symbol"]: row["value"] for row in table("table-3.1")}
    return {"w": w} | {key: float(given[key]) for key in ("k", "r_mean", "rho", "gamma", "gamma_b")}


def fabric_size_factor(w):
    """g3(w), Eq. 3.8, for radii uniform on [2/(w+1), 2w/(w+1)] of the mean."""
    B2, C2 = (float(constants("fabric")[name]["value"]) for name in ("B2", "C2"))
    h2 = ((w - 1) / (w + 1)) ** 2
    m2, m3, m4, m5 = 1 + h2 / 3, 1 + h2, 1 + 2 * h2 + h2**2 / 5, 1 + 10 * h2 / 3 + h2**2
    return (1 - B2 + C2 + (B2 - 2 * C2) * m4 / m3 + C2 * m5 / m3) / (1 + C2 * (m2 - 1))


def jamming_density(mode, w):
    """nu_c(w), Eq. 3.11 with Table 3.2."""
    row = next(r for r in table("table-3.2") if r["mode"] == mode and r["data"] == "thesis")
    low, high = float(row["nu_c_0"]), float(row["nu_c_inf"])
    return high - (high - low) * (3 / w**2 - 2 / w**3)


def isotropic_w3():
    modes = {}
    for row in table("table-2.1"):
        if row["data"] != "thesis":
            continue
        keys = ("C1", "alpha", "nu_c_contacts", "phi_c", "phi_v", "p0", "gamma_p", "nu_c")
        modes[row["mode"]] = {"C0": constant("isotropic", "C0")} | {key: cell(row, key, "Table 2.1") for key in keys}
    return modes


def shear_w3():
    nu_c = constant("shear", "nu_c")
    return {row["quantity"]: {key: cell(row, key, "Table 2.2") for key in ("Q_max", "Q_v", "alpha")} | {"nu_c": nu_c}
            for row in table("table-2.2")}


def moduli_w3():
    group = {}
    for row in table("table-4.1"):
        note = "Table 4.1" + (" (approximate)" if row["approximate"] == "yes" else "")
        group[row["parameter"]] = parameter(row["value"], note, row["pm"])
    group |= {key: constant("moduli", key) for key in ("g3", "GB_max", "Fv_min", "Fv_alpha")}
    order = ("p0", "gamma_p", "nu_c", "g3", "a_I", "a_II", "g_I", "GB_max", "Fv_min", "Fv_alpha")
    return {key: group[key] for key in order}


def memory():
    keys = ("phi_SJ", "mu", "beta", "alpha_max", "alpha_phi", "alpha", "eps0", "eps0_R")  # phi_cr has no number
    return {key: constant("memory", key) for key in keys}


def isotropic_near_jamming():
    """Table 5.1, where phi_J(H) stands in place of nu_c: its value after phi_max = 0.82, and after large shear."""
    rows = {row["parameter"]: row for row in table("table-5.1")}
    jammed = next(r for r in table("text-results") if r["condition"] == "M = 1 and phi_max = 0.82")
    where = "where chapter 5 has phi_J(H)"
    densities = {
        "isotropic": parameter(jammed["value"], f"phi_J after M = 1 and phi_max = 0.82 (Fig. 5.5), {where}"),
        "shear": parameter(constants("memory")["phi_SJ"]["value"], f"phi_SJ, the limit of large shear, {where}"),
    }
    modes = {}
    for mode, column in (("iso", "isotropic"), ("d2", "shear")):
        def take(name):
            row = rows[name]
            spread = row[column + "_pm"]
            return parameter(row[column], join("Table 5.1", f"a range of +- {spread}" if spread else ""))
        nu_c = densities[column]
        modes[mode] = {"C0": constant("isotropic", "C0"), "C1": take("C1"), "alpha": take("theta"),
                       "nu_c_contacts": nu_c, "phi_c": take("phi_c"), "phi_v": take("phi_v"), "p0": take("p0"),
                       "gamma_p": take("gamma_p"), "nu_c": nu_c}
    return modes


def shear_near_jamming():
    nu_c = parameter(constants("memory")["phi_SJ"]["value"], "phi_SJ, where Eq. 5.12 has phi_J(H)")
    return {row["quantity"]: {"Q_max": cell(row, "Q_a", "Table 5.2"), "Q_v": cell(row, "Q_c", "Table 5.2"),
                              "alpha": cell(row, "Psi", "Table 5.2"), "nu_c": nu_c} for row in table("table-5.2")}


def isotropic_of(w):
    modes = {}
    for row in table("table-3.4"):
        if float(row["w"]) != w:
            continue
        nu_c = cell(row, "nu_c", "Table 3.4")
        alpha = parameter(constants("isotropic")["alpha_w"]["value"], "held fixed, text after Eq. 3.12")
        rest = {key: cell(row, key, "Table 3.4") for key in ("C1", "phi_c", "phi_v", "p0", "gamma_p")}
        modes[row["mode"]] = {"C0": constant("isotropic", "C0"), "C1": rest["C1"], "alpha": alpha,
                              "nu_c_contacts": nu_c, "phi_c": rest["phi_c"], "phi_v": rest["phi_v"],
                              "p0": rest["p0"], "gamma_p": rest["gamma_p"], "nu_c": nu_c}
    return modes


def shear_of(w):
    row = next(r for r in table("table-3.3") if float(r["w"]) == w)
    zero = parameter(0, "set to zero, text after Eq. 3.17")
    laws = {}
    for quantity in QUANTITIES:
        if not row[quantity + "_Q_v"]:
            continue  # w = 1 has no growth rates
        laws[quantity] = {key: cell(row, f"{quantity}_{key}", "Table 3.3") if f"{quantity}_{key}" in row else zero
                          for key in ("Q_max", "Q_v", "alpha")} | {"nu_c": cell(row, "nu_c", "Table 3.3")}
    return laws


def moduli_of(w):
    rows = {row["parameter"]: row for row in table("table-4.2")}
    take = lambda name: parameter(rows[name]["value"], "Table 4.2; mean over w = 1 to 10 at nu = 0.751")
    w3 = moduli_w3()
    assumed = lambda name: parameter(w3[name]["value"], "of w = 3; the thesis gives none for this w", source="assumed")
    b_p0 = round(float(rows["b"]["value"]) * float(constants("moduli")["p0_w"]["value"]), 9)
    g3, nu_c = round(fabric_size_factor(w), 6), round(jamming_density("d2", w), 6)
    phi_c = next(float(r["phi_c"]) for r in table("table-3.4") if r["mode"] == "d2" and float(r["w"]) == w)
    C0 = float(constants("isotropic")["C0"]["value"])
    fv_min = w3["Fv_min"] if w == 3 else parameter(
        round(g3 * nu_c * C0 * (1 - phi_c), 4),
        "g3 nu_c C0 (1 - phi_c): the fabric at jamming; the thesis gives none for this w", source="assumed")
    p0_note = ("b p0 = 1.08 x 0.0396 of Table 4.2 and the text after Eq. 4.17; "
               "the 0.0425 printed beside b is their product")
    return {"p0": parameter(b_p0, p0_note),
            "gamma_p": assumed("gamma_p") if w != 3 else w3["gamma_p"],
            "nu_c": parameter(nu_c, "Eq. 3.11 with Table 3.2 (d2)"), "g3": parameter(g3, "Eq. 3.8"),
            "a_I": take("a_I"), "a_II": take("a_II"), "g_I": take("g_I"),
            "GB_max": assumed("GB_max") if w != 3 else w3["GB_max"], "Fv_min": fv_min,
            "Fv_alpha": assumed("Fv_alpha") if w != 3 else w3["Fv_alpha"]}


def parameter_set(name, w, closure, **groups):
    return {"format": "grainlaw-parameters-1", "name": name, "material": material(w), "closure": closure} | groups


def all_sets():
    closure = lambda nu_c: {"P": "iso", "contacts": "d2", "contacts_nu_c": nu_c}
    yield "parameters.json", parameter_set("thesis, w = 3", 3.0, closure("moduli"), isotropic=isotropic_w3(),
                                           shear=shear_w3(), moduli=moduli_w3(), memory=memory())
    yield "near-jamming.json", parameter_set("thesis, w = 3, near jamming", 3.0, closure("row"),
                                             isotropic=isotropic_near_jamming(), shear=shear_near_jamming(),
                                             moduli=moduli_w3(), memory=memory())
    for row in table("table-3.3"):
        w = float(row["w"])
        yield f"w-{row['w']}.json", parameter_set(f"thesis, w = {row['w']}", w, closure("row"),
                                                  isotropic=isotropic_of(w), shear=shear_of(w), moduli=moduli_of(w))


def layout(value, indent=""):
    """JSON with one parameter per line."""
    if not isinstance(value, dict):
        return json.dumps(value, ensure_ascii=False)
    if not any(isinstance(inner, dict) for inner in value.values()):
        return "{" + ", ".join(f"{json.dumps(k)}: {layout(v)}" for k, v in value.items()) + "}"
    inner = indent + "  "
    return "{\n" + ",\n".join(f"{inner}{json.dumps(k)}: {layout(v, inner)}" for k, v in value.items()) + f"\n{indent}}}"


def main():
    check = "--check" in sys.argv[1:]
    differing = []
    for name, content in all_sets():
        file, text = HERE / name, layout(content) + "\n"
        if check:
            if not file.exists() or file.read_text(encoding="utf-8") != text:
                differing.append(name)
        else:
            file.write_text(text, encoding="utf-8")
    if differing:
        print("differ from tables/*.csv (run make_parameters.py): " + ", ".join(differing))
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
