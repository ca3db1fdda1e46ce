#!/usr/bin/env python3
"""Finds the light of a scan by gradient descent through its transfer, with torch.

light_scan.py SCAN.obj|SCAN.ply|SCAN.glb
"""

import sys

import numpy as np
import prtkit
import torch


def shade(transfer, light, albedo):
    """Return the radiance of the vertices, [V, 3]: albedo times transfer [V, 9] times light [9, 3]."""
    return albedo * (transfer @ light)


def fit_light(transfer, albedo, observed, steps=2000):
    """Return the light [9, 3] whose shading matches the observed colors [V, 3]."""
    light = torch.zeros(transfer.shape[1], 3, requires_grad=True)
    optimizer = torch.optim.Adam([light], lr=0.05)
    for _ in range(steps):
        optimizer.zero_grad()
        loss = torch.mean((shade(transfer, light, albedo) - observed) ** 2)
        loss.backward()
        optimizer.step()
    return light.detach()


def main():
    scan = prtkit.load(sys.argv[1])
    values = prtkit.compute_prt(scan.vertices, scan.faces, order=2, convention="prtkit")
    transfer = torch.from_numpy(values).float()
    albedo = torch.full((len(transfer), 1), 0.6)

    # A light to find: a warm sky from above, and a blue one from the left.
    truth = np.zeros((9, 3))
    truth[0] = [1.5, 1.4, 1.3]
    truth[1] = [-0.9, -0.7, -0.4]
    truth[3] = [0.1, 0.2, 0.6]
    observed = shade(transfer, torch.from_numpy(truth).float(), albedo)

    light = fit_light(transfer, albedo, observed)
    print("error of the light:", float(torch.abs(light - torch.from_numpy(truth)).max()))


if __name__ == "__main__":
    main()
