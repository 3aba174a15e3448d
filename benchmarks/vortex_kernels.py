"""The direct sum of vortex segments beside the same loop in C++ and the processor's roots."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import numba
import numpy as np

from galerna.aero.vortex.biot_savart import direct_velocity, segment_table
from galerna.aero.vortex.segments import LANES
from galerna.contract import Array

from .framework import Benchmark, Figure
from .vortex_cases import helical_sheets

PANELS, POINTS = 10_080, 50 * LANES

#: Equation (2) of galerna.aero.vortex.segments over one sheet, LANES points at a time.
LOOP = r"""
#include <algorithm>
#include <cmath>
#include <cstring>
template <int n> struct Row { alignas(64) REAL r[n], inverse[n]; };
constexpr int LANES = 64;
alignas(64) static REAL x[3][LANES], u[3][LANES];
static Row<LANES> row[2][64];

static void distance(const double* v, const double* origin, Row<LANES>& d) {
  const REAL vx = v[0] - origin[0], vy = v[1] - origin[1], vz = v[2] - origin[2];
  for (int i = 0; i < LANES; i++) {
    const REAL a = x[0][i] - vx, b = x[1][i] - vy, c = x[2][i] - vz, square = a*a + b*b + c*c;
    const REAL inverse = 1 / std::sqrt(square + REAL(1e-30));
    d.inverse[i] = square > REAL(1e-10) ? inverse : 0;
    d.r[i] = square * d.inverse[i];
  }
}

static void segment(const double* s, const double* v, const double* origin,
                    const Row<LANES>& d1, const Row<LANES>& d2) {
  if (s[5] == 0) return;
  const double px = v[0] - origin[0], py = v[1] - origin[1], pz = v[2] - origin[2];
  const REAL ex = s[0], ey = s[1], ez = s[2], l2 = s[3], strength = s[5];
  const REAL mx = s[1]*pz - s[2]*py, my = s[2]*px - s[0]*pz, mz = s[0]*py - s[1]*px;
  const REAL least = l2 * REAL(1e-6), core = std::max(REAL(s[4]), REAL(1e-12) * l2 * l2);
  for (int i = 0; i < LANES; i++) {
    const REAL cx = ey*x[2][i] - ez*x[1][i] - mx, cy = ez*x[0][i] - ex*x[2][i] - my,
               cz = ex*x[1][i] - ey*x[0][i] - mz, square = cx*cx + cy*cy + cz*cz;
    const REAL sum = d1.r[i] + d2.r[i], D = std::max(sum*sum - l2, least);
    const REAL f = strength * (d1.inverse[i] + d2.inverse[i]) * square
                 / std::sqrt(D*D*(square*square + core) + REAL(1e-36));
    u[0][i] += f*cx; u[1][i] += f*cy; u[2][i] += f*cz;
  }
}

extern "C" void lattice(const double* table, int rows, int columns, const double* points,
                        int count, double* velocity) {
  for (int first = 0; first < count; first += LANES) {
    const double* origin = points + 3*first;
    for (int i = 0; i < LANES; i++)
      for (int k = 0; k < 3; k++) x[k][i] = points[3*(first + i) + k] - origin[k];
    for (int r = 0; r < rows; r++) {
      std::memset(u, 0, sizeof u);
      for (int c = 0; c < columns; c++) {
        const double* v = table + 15*(r*columns + c);
        Row<LANES>& here = row[r % 2][c];
        distance(v, origin, here);
        if (c > 0) segment(v + 3, v, origin, row[r % 2][c - 1], here);
        if (r > 0) segment(v + 9, v, origin, row[(r + 1) % 2][c], here);
      }
      for (int i = 0; i < LANES; i++)
        for (int k = 0; k < 3; k++) velocity[3*(first + i) + k] += u[k][i];
    }
  }
}
"""


def cpu_seconds(function: Callable[[], object], repeat: int = 5) -> float:
    """Least CPU seconds of ``function()`` over ``repeat`` runs, after one warm-up."""
    function()
    times = []
    for _ in range(repeat):
        start = time.process_time()
        function()
        times.append(time.process_time() - start)
    return min(times)


def compiled_loop(real: str, folder: str) -> ctypes.CDLL | None:
    """The C++ loop for ``real`` "double" or "float"; None without a compiler."""
    compiler = shutil.which("c++")
    if compiler is None:
        print("no C++ compiler: the loop to compare with is left out")
        return None
    source, library = Path(folder) / f"{real}.cpp", Path(folder) / f"{real}.so"
    source.write_text(LOOP.replace("REAL", real))
    flags = ["-O3", "-march=native", "-ffast-math", "-std=c++17", "-shared", "-fPIC"]
    command = [compiler, *flags, str(source), "-o", str(library)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode:
        print(f"the C++ loop does not compile: {run.stderr.splitlines()[:1]}")
        return None
    return ctypes.CDLL(str(library))


@numba.njit(fastmath=True, error_model="numpy")
def roots(x, out, repeat):  # type: ignore[no-untyped-def]
    """One division and one square root a number, over and over."""
    for _ in range(repeat):
        for i in range(len(x)):
            out[i] += 1.0 / np.sqrt(x[i] + out[i])


def root_limit() -> float:
    """Nanoseconds a panel and point would cost if its three roots and divisions were all."""
    x, out = np.random.default_rng(0).uniform(1.0, 2.0, 512), np.zeros(512)
    return 3.0 * cpu_seconds(lambda: roots(x, out, 2000)) / (512 * 2000) * 1e9


def kernels() -> Sequence[Figure]:
    """CPU time a panel and point on one core, in both precisions."""
    [sheet, *_] = helical_sheets(3 * PANELS)
    table, [[_, rows, columns]] = segment_table([sheet])
    points = np.ascontiguousarray(sheet.vertices.reshape(-1, 3)[:POINTS])
    pairs = sheet.circulation.size * len(points) / 1e9
    threads, figures = numba.get_num_threads(), []
    numba.set_num_threads(1)
    with tempfile.TemporaryDirectory() as folder:
        for precision, real, wanted in (("double", "double", 315.0), ("single", "float", 560.0)):
            ours = cpu_seconds(partial(direct_velocity, [sheet], points, precision)) / pairs
            library, theirs = compiled_loop(real, folder), None
            if library is not None:
                theirs = cpu_seconds(partial(in_cpp, library, table, rows, columns, points))
                theirs /= pairs
            name = f"direct sum in {precision} precision, CPU time a panel and point"
            peer = "C++, the same loop" if theirs else ""
            bound = 2.0 * theirs if theirs else 1e3 / wanted
            figures.append(Figure(name, ours, "ns", bound, peer=peer, peer_value=theirs))
    numba.set_num_threads(threads)
    limit = root_limit()
    figures.append(Figure("three roots and divisions, double precision", limit, "ns"))
    return figures


def in_cpp(library: ctypes.CDLL, table: Array, rows: int, columns: int, points: Array) -> Array:
    """Velocity (k,3) m/s by the C++ loop."""
    velocity = np.zeros_like(points)
    address = [ctypes.c_void_p(a.ctypes.data) for a in (table, points, velocity)]
    library.lattice(address[0], int(rows), int(columns), address[1], len(points), address[2])
    return velocity


BENCHMARKS = [Benchmark("vortex-kernels", "vortex", "Direct sums of vortex segments", kernels)]
