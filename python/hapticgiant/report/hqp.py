"""The table of `hapticgiant hqp solve --timing`."""

from . import bench


def row(start, cells):
    return f"{start:5} " + " ".join(f"{cell:>9}" for cell in cells)


def write(results, folder, docs=None):
    del folder, docs
    count = len(results["cold"])
    print(f"{count} problem{'' if count == 1 else 's'}, microseconds per problem")
    print(row("start", ("median", "mean", "99.9 %", "max")))
    for start in ("cold", "warm"):
        times = bench.distribution(results[start])
        us = (times["median_us"], bench.mean(results[start]), times["p99_9_us"], times["max_us"])
        print(row(start, [bench.number(it, 2) for it in us]))
