"""Measures this project's forests beside scikit-learn's; compare_trees.sh runs it."""
import argparse
import json
import multiprocessing
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time

import numpy
from sklearn.ensemble import ExtraTreesRegressor

TREES = 25
TEST_POINTS = 100_000


def friedman(rows, inputs, seed, noise):
    """Friedman's function 1, its first terms for 3 inputs; inputs after the fifth do not matter."""
    generator = numpy.random.default_rng(seed)
    x = generator.random((rows, inputs))
    y = 10 * numpy.sin(numpy.pi * x[:, 0] * x[:, 1]) + 20 * (x[:, 2] - 0.5) ** 2
    if inputs > 4:
        y += 10 * x[:, 3] + 5 * x[:, 4]
    return x, y + noise * generator.standard_normal(rows)


def user_seconds():
    return resource.getrusage(resource.RUSAGE_SELF).ru_utime


def status_kb(name):
    with open("/proc/self/status", encoding="ascii") as status:
        return next(int(line.split()[1]) for line in status if line.startswith(name))


class Ours:
    """The driver, as a process that waits for commands."""

    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        self.process = subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def ask(self, command):
        self.process.stdin.write(command + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            sys.exit(f"the driver ended at: {command}")
        return json.loads(answer)

    def give(self, what, x, y):
        name = os.path.join(self.folder, what)
        with open(name, "wb") as file:
            file.write(x.tobytes(order="F"))
            file.write(y.tobytes())
        self.ask(f"{what} {name} {x.shape[0]} {x.shape[1]}")
        os.remove(name)

    def fit(self, component="extra_trees", threads=1, **attributes):
        if component == "extra_trees":
            attributes["trees"] = TREES
        text = " ".join(f'{name}="{value}"' for name, value in attributes.items())
        return self.ask(f"fit {threads} <{component} {text}/>")

    def rmse(self):
        return self.ask("rmse")["rmse"]


class Data:
    def __init__(self, ours, rows, inputs, seed=1):
        self.rows, self.inputs = rows, inputs
        x, self.y = friedman(rows, inputs, seed, 1)
        test_x, self.test_y = friedman(TEST_POINTS, inputs, seed + 1000, 0)
        ours.give("train", x, self.y)
        ours.give("test", test_x, self.test_y)
        self.x, self.test_x = x.astype(numpy.float32), test_x.astype(numpy.float32)

    def __str__(self):
        return f"{self.rows:.0e} x {self.inputs}".replace("e+0", "e")

    def sklearn(self, leaf, seed):
        forest = ExtraTreesRegressor(TREES, min_samples_leaf=leaf, max_features=1.0, random_state=seed)
        begin = user_seconds()
        forest.fit(self.x, self.y)
        return forest, user_seconds() - begin

    def sklearn_rmse(self, forest):
        return float(numpy.sqrt(numpy.mean((forest.predict(self.test_x) - self.test_y) ** 2)))


class Table:
    def __init__(self):
        print(f"{'measure':<58}{'here':>11}{'peer':>11}{'ratio':>9}   bar")

    def row(self, measure, here, peer, ratio, bar=None, unit="s"):
        """bar: (least or None, most or None) of the ratio."""
        def number(value):
            return "" if value is None else f"{value:.4g} {unit}"
        verdict = ""
        if bar is not None:
            least, most = bar
            met = (least is None or ratio >= least) and (most is None or ratio <= most)
            verdict = (f">= {least}" if most is None else f"<= {most}" if least is None else f"{least} to {most}")
            verdict += "  met" if met else "  MISSED"
        shown = "" if ratio is None else f"{ratio:.3g}"
        print(f"{measure:<58}{number(here):>11}{number(peer):>11}{shown:>9}   {verdict}", flush=True)


def least_speedup(kernels, leaf):
    """Depends on the processor: any is enough for the lower bar, AVX2 and AVX-512 reach the higher ones."""
    return 4 if kernels == "portable" else 10 if leaf > 1 else 6


def fit_constant(ours, table, options):
    """Fitting, same rule; and what the thesis's rule costs."""
    kernels = ours.ask("kernels")["name"]
    sizes = [(10**4, 3), (10**4, 9)] if options.quick else [(10**4, 3), (10**5, 3), (10**5, 9), (10**6, 9)]
    for rows, inputs in sizes:
        if rows > options.up_to:
            continue
        data = Data(ours, rows, inputs)
        for leaf in (10, 1):
            peer, same, redraw = [], [], []
            for seed in range(options.rounds):
                peer.append(data.sklearn(leaf, seed)[1])
                for _ in range(3 if rows < 10**5 else 1):  # short times are coarse
                    same.append(ours.fit(n_min=leaf, too_few="reject")["cpu_s"])
                    redraw.append(ours.fit(n_min=leaf)["cpu_s"])
            here, there = statistics.median(same), statistics.median(peer)
            table.row(f"fit, constant leaves, {data}, leaf {leaf}", here, there, there / here,
                      (least_speedup(kernels, leaf), None))
            if leaf > 1:
                cost = statistics.median(redraw)
                table.row(f"  the n_min rule beside the plain one, {data}", cost, here, cost / here, (None, 1.4))


def fit_linear(ours, table, options):
    """Fitting linear leaves beside scikit-learn's constant ones, and their errors."""
    sizes = [(10**4, 3, 50, 0.55, 0.6)] + ([] if options.quick else [(10**5, 9, 99, 0.6, 0.35)])
    for rows, inputs, n_min, time_bar, error_bar in sizes:
        data = Data(ours, rows, inputs)
        peer, linear = [], []
        for seed in range(options.rounds):
            peer.append(data.sklearn(10, seed)[1])
            linear.append(ours.fit(leaves="pwl", n_min=n_min)["cpu_s"])
        error = ours.rmse()
        here, there = statistics.median(linear), statistics.median(peer)
        table.row(f"fit, linear leaves of {n_min}, {data} (peer: leaf 10)", here, there, here / there, (None, time_bar))
        errors = {}
        for leaf in (1, 3, 5, 10, 20):
            for rule in ("reject", "redraw"):
                ours.fit(n_min=leaf, too_few=rule)
                errors[leaf, rule] = ours.rmse()
        best = min(errors, key=errors.get)
        table.row(f"  error beside the best constant leaves ({best[0]}, {best[1]})", error, errors[best],
                  error / errors[best], (None, error_bar), unit="")


def accuracy(ours, table, options):
    """Mean test error over seeds, same rule."""
    seeds = 10
    for rows, inputs, leaf in [(2000, 3, 5), (10**4, 9, 1)] if options.quick else [(10**4, 3, 10), (10**4, 9, 1),
                                                                                  (10**4, 9, 10)]:
        here, there = [], []
        for seed in range(seeds):
            data = Data(ours, rows, inputs, seed=10 + seed)
            there.append(data.sklearn_rmse(data.sklearn(leaf, seed)[0]))
            ours.fit(n_min=leaf, too_few="reject")
            here.append(ours.rmse())
        here, there = statistics.mean(here), statistics.mean(there)
        table.row(f"test error, mean over {seeds} seeds, {data}, leaf {leaf}", here, there, here / there, (0.98, 1.02),
                  unit="")


def calls(ours, table, options):
    """One call, in a chain of calls that depend on each other; peer: the textbook layout."""
    cases = [(10**4, 50, 4), (10**4, 10, 8)] + ([] if options.quick else [(10**5, 10, 8)])
    for rows, leaf, bar in cases:
        Data(ours, rows, 3)
        leaves = ours.fit(n_min=leaf, too_few="reject")["leaves"]
        times = ours.ask("call")
        table.row(f"one call, {TREES} trees of {leaves:.0f} constant leaves", times["ns"], times["textbook_ns"],
                  times["textbook_ns"] / times["ns"], (bar, None), unit="ns")
        table.row("  cold caches", times["cold_us"], times["cold_textbook_us"],
                  times["cold_textbook_us"] / times["cold_us"], unit="us")
    Data(ours, 10**4, 3)
    leaves = ours.fit(leaves="pwl", n_min=50)["leaves"]
    times = ours.ask("call")
    table.row(f"one call, {TREES} trees of {leaves:.0f} linear leaves; bar 600 ns", times["ns"], 600,
              times["ns"] / 600, (None, 1), unit="ns")
    Data(ours, 4096, 3)
    depth = ours.ask("balanced 12 3")
    times = ours.ask("call")
    table.row(f"one call, a tree of depth 12, {depth['leaves']:.0f} leaves; bar 60 ns", times["ns"], 60,
              times["ns"] / 60, (None, 1), unit="ns")


def batch(ours, table, options):
    """Points a second of one thread."""
    cases = [(10**4, 3, 10)] if options.quick else [(10**4, 3, 50), (10**4, 3, 10), (10**5, 3, 10), (10**5, 9, 10)]
    for rows, inputs, leaf in cases:
        data = Data(ours, rows, inputs)
        forest = data.sklearn(leaf, 0)[0]
        ours.fit(n_min=leaf, too_few="reject")
        here, there = [], []
        for _ in range(options.rounds):
            begin = user_seconds()
            forest.predict(data.test_x)
            there.append(user_seconds() - begin)
            here.append(ours.ask("batch")["cpu_s"])
        here, there = (TEST_POINTS / statistics.median(times) / 1e6 for times in (here, there))
        table.row(f"batch, million points a second, {data}, leaf {leaf}", here, there, here / there, (3, None), unit="M/s")


def threads(ours, table, options):
    """CPU seconds of two threads beside those of one."""
    data = Data(ours, 10**4 if options.quick else 10**5, 9)
    times = {1: [], 2: []}
    walls = {1: [], 2: []}
    for _ in range(max(options.rounds, 5)):
        for count, cpu in times.items():
            fitted = ours.fit(threads=count, n_min=10)
            cpu.append(fitted["cpu_s"])
            walls[count].append(fitted["wall_s"])
    one, two = statistics.median(times[1]), statistics.median(times[2])
    table.row(f"CPU time, two threads beside one, {data}, leaf 10", two, one, two / one, (None, 1.08))
    one, two = statistics.median(walls[1]), statistics.median(walls[2])
    table.row("  wall time", two, one, two / one)


def sklearn_peak_mb(rows, inputs, leaf):
    x, y = friedman(rows, inputs, 1, 1)
    x = x.astype(numpy.float32)
    forest = ExtraTreesRegressor(TREES, min_samples_leaf=leaf, max_features=1.0, random_state=0)
    with open("/proc/self/clear_refs", "w", encoding="ascii") as forget:
        forget.write("5")
    before = status_kb("VmRSS:")
    forest.fit(x, y)
    return (status_kb("VmHWM:") - before) / 1024


def memory(ours, table, options):
    """Peak memory of fitting beyond what is in use before, each in a fresh process: a heap has room from before."""
    rows, inputs, leaf = 10**4 if options.quick else 10**5, 9, 10
    ours = Ours(ours.program, ours.folder)
    data = Data(ours, rows, inputs)
    here = ours.fit(n_min=leaf, too_few="reject")["peak_kb"] / 1024
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        there = pool.apply(sklearn_peak_mb, (rows, inputs, leaf))
    table.row(f"peak memory beyond the data, {data}, leaf {leaf}", here, there, here / there, (None, 0.34), unit="MB")


SECTIONS = {"fit": fit_constant, "linear": fit_linear, "accuracy": accuracy, "calls": calls, "batch": batch,
            "threads": threads, "memory": memory}


def main():
    parser = argparse.ArgumentParser(prog="compare_trees.sh", description=__doc__)
    parser.add_argument("driver", help=argparse.SUPPRESS)
    parser.add_argument("quick", nargs="?", choices=["quick"], help="small sizes only")
    parser.add_argument("--rounds", type=int, default=5, help="interleaved rounds (default 5)")
    parser.add_argument("--only", action="append", choices=SECTIONS, help="a section of the table")
    parser.add_argument("--up-to", type=int, default=10**6, help="fits of more samples are left out (default 1000000)")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        ours = Ours(options.driver, folder)
        print(f"kernels: {ours.ask('kernels')['name']}; times are user CPU seconds, medians of {options.rounds} rounds; "
              f"{time.strftime('%F')}")
        table = Table()
        for name in options.only or SECTIONS:
            SECTIONS[name](ours, table, options)


if __name__ == "__main__":
    main()
