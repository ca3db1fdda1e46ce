#!/usr/bin/env python3
"""Plots the error of compression against bytes per vertex.

plot_error.py SCENE.glb|BAKE.glb [-o ERROR.png] [--bytes 5 7 9 13] [--lights SKY.hdr ...]
"""

import argparse
import math

import matplotlib.pyplot as plt
import prtkit


def measure(bake, budgets, lights):
    """Return one record per budget: bytes, relative L2 and contrast error of the worst light, and the verdict."""
    records = []
    for budget in budgets:
        model = prtkit.compress(bake, bytes_per_vertex=budget, best_effort=True, lights=lights)
        report = prtkit.evaluate(bake, model, lights=lights)
        records.append(
            {
                "bytes": report["bytes_bound_per_vertex_with_bases"],
                "relative_l2": max(light["lit_rms"] for light in report["lights"]),
                "verdict": report["verdict"],
            }
        )
    return records


def plot(records, path):
    figure, axes = plt.subplots(figsize=(6, 4))
    axes.loglog([r["bytes"] for r in records], [r["relative_l2"] for r in records], "o-")
    axes.set_xlabel("bytes per vertex, with bases")
    axes.set_ylabel("relative L2 of exit radiance, worst light")
    axes.grid(True, which="both", alpha=0.3)
    figure.tight_layout()
    figure.savefig(path, dpi=120)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("-o", "--output", default="error.png")
    parser.add_argument("--bytes", type=float, nargs="+", default=[5, 7, 9, 13])
    parser.add_argument("--lights", nargs="*", default=[])
    parser.add_argument("--rays", type=int, default=1024)
    parser.add_argument("--bounces", type=float, default=3)
    options = parser.parse_args()

    model = prtkit.load(options.scene)
    bake = (
        model if model.content == "baked" else prtkit.bake(model, rays=options.rays, bounces=options.bounces)
    )
    records = measure(bake, options.bytes, options.lights)
    for record in records:
        print(f"{record['bytes']:6.2f} bytes  {100 * record['relative_l2']:6.2f} %  {record['verdict']}")
    plot([r for r in records if math.isfinite(r["relative_l2"])], options.output)


if __name__ == "__main__":
    main()
