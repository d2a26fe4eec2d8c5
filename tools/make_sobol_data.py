#!/usr/bin/env python3
"""Writes src/samplers/data/joe_kuo.inl, the direction numbers of the Sobol' sampler.

The table is committed; this is run only to change it. It reads Joe and Kuo's numbers (new-joe-kuo-6.21201) from a
wheel of SciPy, which ships them:
    pip download scipy --no-deps --only-binary :all:
    python3 tools/make_sobol_data.py scipy-*.whl
"""
import io
import pathlib
import struct
import sys
import zipfile

DIMENSIONS = 1024
FILE = pathlib.Path(__file__).resolve().parent.parent / "src" / "samplers" / "data" / "joe_kuo.inl"
HEADER = """\
// Sobol' direction numbers "new-joe-kuo-6.21201" of S. Joe and F. Y. Kuo ("Constructing Sobol' sequences with
// better two-dimensional projections", SIAM J. Sci. Comput. 30, 2635-2654, 2008): of the first 1024 dimensions all
// but the first, which needs none. Each dimension: its primitive polynomial over GF(2) as a bit mask, highest power
// first, then as many odd numbers m_1, m_2 ... as the polynomial's degree. The licence of the direction numbers:
//
// Copyright (c) 2008, Frances Y. Kuo and Stephen Joe
// All rights reserved.
//
// Redistribution and use in source and binary forms, with or without modification, are permitted provided that the
// following conditions are met:
//
//     * Redistributions of source code must retain the above copyright notice, this list of conditions and the
//       following disclaimer.
//
//     * Redistributions in binary form must reproduce the above copyright notice, this list of conditions and the
//       following disclaimer in the documentation and/or other materials provided with the distribution.
//
//     * Neither the names of the copyright holders nor the names of the University of New South Wales and the
//       University of Waikato and its contributors may be used to endorse or promote products derived from this
//       software without specific prior written permission.
//
// THIS SOFTWARE IS PROVIDED BY THE COPYRIGHT HOLDERS ``AS IS'' AND ANY EXPRESS OR IMPLIED WARRANTIES, INCLUDING, BUT
// NOT LIMITED TO, THE IMPLIED WARRANTIES OF MERCHANTABILITY AND FITNESS FOR A PARTICULAR PURPOSE ARE DISCLAIMED. IN
// NO EVENT SHALL THE COPYRIGHT HOLDERS OR CONTRIBUTORS BE LIABLE FOR ANY DIRECT, INDIRECT, INCIDENTAL, SPECIAL,
// EXEMPLARY, OR CONSEQUENTIAL DAMAGES (INCLUDING, BUT NOT LIMITED TO, PROCUREMENT OF SUBSTITUTE GOODS OR SERVICES;
// LOSS OF USE, DATA, OR PROFITS; OR BUSINESS INTERRUPTION) HOWEVER CAUSED AND ON ANY THEORY OF LIABILITY, WHETHER IN
// CONTRACT, STRICT LIABILITY, OR TORT (INCLUDING NEGLIGENCE OR OTHERWISE) ARISING IN ANY WAY OUT OF THE USE OF THIS
// SOFTWARE, EVEN IF ADVISED OF THE POSSIBILITY OF SUCH DAMAGE.
"""


def load(archive, name):
    """The integers of an .npy array and its shape; Fortran order is kept."""
    data = archive.read(name)
    size = struct.unpack("<H", data[8:10])[0]
    description = eval(data[10:10 + size], {"__builtins__": {}})
    assert description["descr"] == "<i8"
    body = data[10 + size:]
    return struct.unpack(f"<{len(body) // 8}q", body), description


def main():
    wheel = zipfile.ZipFile(sys.argv[1])
    name = next(n for n in wheel.namelist() if n.endswith("_sobol_direction_numbers.npz"))
    archive = zipfile.ZipFile(io.BytesIO(wheel.read(name)))
    polynomials, _ = load(archive, "poly.npy")
    initial, description = load(archive, "vinit.npy")
    rows, columns = description["shape"]
    assert description["fortran_order"]

    lines, line = [], ""
    for d in range(1, DIMENSIONS):
        degree = polynomials[d].bit_length() - 1
        numbers = [initial[d + i * rows] for i in range(degree)]
        assert all(m % 2 == 1 and m < 2 ** (i + 1) for i, m in enumerate(numbers))
        assert all(initial[d + i * rows] == 0 for i in range(degree, columns))
        for n in [polynomials[d], *numbers]:
            if len(line) + len(str(n)) + 2 > 110:
                lines.append(line)
                line = ""
            line += ("" if not line else " ") + f"{n},"
    lines.append(line)
    FILE.write_text(HEADER + "\n".join(lines) + "\n")


main()
