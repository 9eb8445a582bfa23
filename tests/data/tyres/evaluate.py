#!/usr/bin/python3
"""Evaluates the tyre property files of this folder by the published equations.

  tests/data/tyres/evaluate.py     writes FILE.csv for each FILE.tir of this folder

Independent of the program: reads the raw coefficients, and applies scale factors and inflation
pressure in the equations, as published. Files with FITTYP 61: Pacejka 2012, equations 4.E1 to 4.E67
without turn slip. Other files: PAC2002 of Adams/Tire (MF5.2), whose camber shifts differ. The axes
are those of the files, ISO 8855: the camber is positive if the top leans to the right.
tests/vehicle/tyre_file_test.cpp compares the program with these forces.
"""

import math
import pathlib

FOLDER = pathlib.Path(__file__).resolve().parent


def read(file):
    """The numbers of a file by key; units are SI, except for the force."""
    numbers = {}
    for line in file.read_text().splitlines():
        line = line.split("$")[0].split("!")[0]
        key, equal, value = line.partition("=")
        if not equal:
            continue
        key, value = key.strip().upper(), value.strip()
        try:
            numbers[key] = float(value.replace("D", "e"))
        except ValueError:
            numbers[key] = value.strip("'\"").upper()
    return numbers


def sine(c, b, e, x):
    return math.sin(c * math.atan(b * x - e * (b * x - math.atan(b * x))))


def cosine(c, b, e, x):
    return math.cos(c * math.atan(b * x - e * (b * x - math.atan(b * x))))


def sign(x):
    return (x > 0) - (x < 0)


def forces(p, load, kappa, alpha, gamma):
    """(F_x, F_y) in newtons."""

    def c(key, default=0.0):
        return p.get(key, default)

    new = p.get("FITTYP") in (60, 61, 62)
    newton = 1e3 if p.get("FORCE") in ("KNEWTON", "KN") else 1.0
    nominal = c("FNOMIN") * newton * c("LFZO", 1)
    dfz = (load - nominal) / nominal  # 4.E2a
    pressure = c("INFLPRES", c("NOMPRES")) if new else 0.0
    dpi = (pressure - c("NOMPRES")) / c("NOMPRES") if new and c("NOMPRES") else 0.0  # 4.E2b
    if new:
        slip, lean_x, lean = math.tan(alpha), gamma, math.sin(gamma)  # 4.E3, 4.E4
    else:
        slip, lean_x, lean = alpha, gamma * c("LGAX", 1), gamma * c("LGAY", 1)

    def digressive(scale):  # 4.E8
        return 10 * scale / (1 + 9 * scale) if new else scale

    # pure longitudinal slip, 4.E9 to 4.E18
    shift = (c("PHX1") + c("PHX2") * dfz) * c("LHX", 1)
    mu = (c("PDX1") + c("PDX2") * dfz) * (1 - c("PDX3") * lean_x**2) * c("LMUX", 1)
    mu *= 1 + c("PPX3") * dpi + c("PPX4") * dpi**2
    shape = c("PCX1") * c("LCX", 1)
    curvature = (c("PEX1") + c("PEX2") * dfz + c("PEX3") * dfz**2) * c("LEX", 1)
    curvature *= 1 - c("PEX4") * sign(kappa + shift)
    stiffness = load * (c("PKX1") + c("PKX2") * dfz) * math.exp(c("PKX3") * dfz) * c("LKX", 1)
    stiffness *= 1 + c("PPX1") * dpi + c("PPX2") * dpi**2
    lift = load * (c("PVX1") + c("PVX2") * dfz) * c("LVX", 1) * digressive(c("LMUX", 1))
    b = stiffness / (shape * mu * load)
    fx0 = mu * load * sine(shape, b, min(1, curvature), kappa + shift) + lift

    # pure lateral slip, 4.E19 to 4.E30
    k4, k5 = (c("PKY4"), c("PKY5")) if new else (2, 0)
    stiffness = c("PKY1") * nominal * (1 - c("PKY3") * abs(lean)) * c("LKY", 1)
    stiffness *= 1 + c("PPY1") * dpi
    best = (c("PKY2") + k5 * lean**2) * (1 + c("PPY2") * dpi)
    stiffness *= math.sin(k4 * math.atan(load / nominal / best))
    mu_y = (c("PDY1") + c("PDY2") * dfz) * (1 - c("PDY3") * lean**2) * c("LMUY", 1)
    mu_y *= 1 + c("PPY3") * dpi + c("PPY4") * dpi**2
    shape = c("PCY1") * c("LCY", 1)
    by_camber = load * (c("PVY3") + c("PVY4") * dfz) * lean * digressive(c("LMUY", 1))
    if new:
        by_camber *= c("LKYC", 1)
        camber_stiffness = load * (c("PKY6") + c("PKY7") * dfz) * c("LKYC", 1)
        camber_stiffness *= 1 + c("PPY5") * dpi
        camber_shift = (camber_stiffness * lean - by_camber) / stiffness
    else:
        camber_shift = c("PHY3") * lean
    shift = (c("PHY1") + c("PHY2") * dfz) * c("LHY", 1) + camber_shift
    lift = load * (c("PVY1") + c("PVY2") * dfz) * c("LVY", 1) * digressive(c("LMUY", 1)) + by_camber
    curvature = (c("PEY1") + c("PEY2") * dfz) * c("LEY", 1)
    squared = c("PEY5") * lean**2 if new else 0
    curvature *= 1 + squared - (c("PEY3") + c("PEY4") * lean) * sign(slip + shift)
    b = stiffness / (shape * mu_y * load)
    fy0 = mu_y * load * sine(shape, b, min(1, curvature), slip + shift) + lift

    # combined slip, 4.E50 to 4.E67; the camber is not scaled
    lean = math.sin(gamma) if new else gamma
    b3, b4 = (c("RBX3"), c("RBY4")) if new else (0, 0)
    b = (c("RBX1") + b3 * lean**2) * math.cos(math.atan(c("RBX2") * kappa)) * c("LXAL", 1)
    e = c("REX1") + c("REX2") * dfz
    fx = fx0 * cosine(c("RCX1"), b, e, slip + c("RHX1")) / cosine(c("RCX1"), b, e, c("RHX1"))
    b = c("RBY1") + b4 * lean**2
    b *= math.cos(math.atan(c("RBY2") * (slip - c("RBY3")))) * c("LYKA", 1)
    e = c("REY1") + c("REY2") * dfz
    shift = c("RHY1") + c("RHY2") * dfz
    weight = cosine(c("RCY1"), b, e, kappa + shift) / cosine(c("RCY1"), b, e, shift)
    side = mu_y * load * (c("RVY1") + c("RVY2") * dfz + c("RVY3") * lean)
    side *= math.cos(math.atan(c("RVY4") * slip))
    side *= math.sin(c("RVY5") * math.atan(c("RVY6") * kappa)) * c("LVYKA", 1)
    return fx, weight * fy0 + side


def main():
    for file in sorted(FOLDER.glob("*.tir")):
        p = read(file)
        rows = ["load_N,slip_ratio,slip_angle_rad,camber_iso_rad,longitudinal_force_N,lateral_force_N"]
        for load in (1500.0, 4000.0, 6500.0):
            for kappa in (-1.0, -0.2, -0.03, 0.0, 0.02, 0.1, 0.5):
                for alpha in (-0.6, -0.12, -0.01, 0.0, 0.04, 0.3):
                    for gamma in (-0.06, 0.0, 0.02, 0.08):
                        force = forces(p, load, kappa, alpha, gamma)
                        row = (load, kappa, alpha, gamma, *force)
                        rows.append(",".join(repr(number) for number in row))
        file.with_suffix(".csv").write_text("\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
