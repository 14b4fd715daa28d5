#!/usr/bin/env python3
"""Draws docs/pictures/packing.png: a packing of `grainlaw export`, its grains left, its force chains right.

Usage: docs/pictures/packing.py [SNAPSHOTS.h5, default out/d2/snapshots.h5]   (data/scenes/d2.json makes those)

Needs no more than Python and gnuplot: spheres and bars are drawn here, in a view along parallel rays.
"""
import math
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
SIZE, FINER = 440, 2  # pixels across a panel, and how many times finer it is drawn
LIGHT = (-0.42, 0.55, 0.72)
CONTACTS = [(0.93, 0.91, 0.84), (0.55, 0.78, 0.74), (0.16, 0.50, 0.63), (0.10, 0.22, 0.42)]  # 0 ... 12
FORCES = [(0.80, 0.82, 0.85), (0.95, 0.70, 0.35), (0.82, 0.22, 0.16), (0.40, 0.02, 0.10)]  # 0 ... 4 mean forces


def mixed(colours, share):
    """The colour at `share` (0 ... 1) of a scale."""
    at = min(max(share, 0), 0.9999) * (len(colours) - 1)
    a, b = colours[int(at)], colours[int(at) + 1]
    return tuple(p + (at - int(at)) * (q - p) for p, q in zip(a, b))


def read_vtp(file):
    """All arrays of a VTP file by name, as lists of numbers."""
    arrays = {}
    for array in xml.etree.ElementTree.parse(file).iter("DataArray"):
        arrays[array.get("Name")] = [float(word) for word in array.text.split()]
    return arrays


def view(x, box):
    """Turned about the vertical y axis and tipped a little; the middle of the box is the origin."""
    x, y, z = (a - 0.5 * b for a, b in zip(x, box))
    turn, tip = math.radians(24), math.radians(16)
    x, z = math.cos(turn) * x - math.sin(turn) * z, math.sin(turn) * x + math.cos(turn) * z
    y, z = math.cos(tip) * y - math.sin(tip) * z, math.sin(tip) * y + math.cos(tip) * z
    return x, y, z  # z towards the eye


class Panel:
    """A picture with depth. Lengths are in mm; `width` of them fill it."""

    def __init__(self, width, depth):
        self.n = SIZE * FINER
        self.scale, self.depth = self.n / width, depth
        self.colour = [(1.0, 1.0, 1.0)] * (self.n * self.n)
        self.nearest = [-math.inf] * (self.n * self.n)

    def rows(self, low, high):
        return range(max(0, int(low)), min(self.n, int(high) + 1))

    def pixel(self, row, column, z, normal, colour):
        at = row * self.n + column
        if z <= self.nearest[at]:
            return
        self.nearest[at] = z
        light = 0.42 + 0.62 * max(0.0, sum(a * b for a, b in zip(normal, LIGHT)))
        haze = 0.45 * min(1.0, max(0.0, 0.5 - z / self.depth))  # what is far fades
        self.colour[at] = tuple((1 - haze) * min(1.0, light * c) + haze for c in colour)

    def bar(self, a, b, radius, colour):
        """A rounded bar from a to b; a sphere where both are the same."""
        half, s = 0.5 * self.n, self.scale
        ax, ay, bx, by, r = half + s * a[0], half - s * a[1], half + s * b[0], half - s * b[1], s * radius
        ux, uy = bx - ax, by - ay
        square = ux * ux + uy * uy
        for row in self.rows(min(ay, by) - r, max(ay, by) + r):
            for column in self.rows(min(ax, bx) - r, max(ax, bx) + r):
                px, py = column + 0.5 - ax, row + 0.5 - ay
                t = min(1.0, max(0.0, (px * ux + py * uy) / square)) if square > 0 else 0.0
                dx, dy = px - t * ux, py - t * uy
                left = r * r - dx * dx - dy * dy
                if left > 0:
                    up = math.sqrt(left)
                    self.pixel(row, column, a[2] + t * (b[2] - a[2]) + up / s, (dx / r, -dy / r, up / r), colour)

    def write(self, file):
        """Bytes red, green, blue from the lower left corner up, as gnuplot reads them."""
        out = bytearray()
        for row in reversed(range(SIZE)):
            for column in range(SIZE):
                block = [self.colour[(row * FINER + i) * self.n + column * FINER + j]
                         for i in range(FINER) for j in range(FINER)]
                # 40 levels are enough for the eye and make a file half as long.
                out += bytes(round(sum(c[k] for c in block) / len(block) * 39) * 255 // 39 for k in range(3))
        with open(file, "wb") as stream:
            stream.write(out)


def draw(arrays, folder):
    box = arrays["box"][::4]  # the diagonal: edges along the axes
    triples = [arrays["Points"][i:i + 3] for i in range(0, len(arrays["Points"]), 3)]
    points = [view(x, box) for x in triples]
    across = 1.04 * max(box[0] * math.cos(math.radians(24)) + box[2] * math.sin(math.radians(24)), 1.25 * box[1])
    grains, forces = Panel(across + 1, max(box)), Panel(across + 1, max(box))
    for place, radius, contacts in zip(points, arrays["radius"], arrays["contacts"]):
        if radius > 0:
            grains.bar(place, place, radius, mixed(CONTACTS, contacts / 12))
    ends = [int(i) for i in arrays["connectivity"]]
    mean_radius = sum(arrays["radius"]) / sum(1 for r in arrays["radius"] if r > 0)
    for a, b, force in zip(ends[::2], ends[1::2], arrays["force_over_mean"]):
        forces.bar(points[a], points[b], 0.14 * mean_radius * math.sqrt(force), mixed(FORCES, force / 4))
    grains.write(folder + "/grains.rgb")
    forces.write(folder + "/forces.rgb")


def palette(colours):
    return "(" + ", ".join("%g '#%02x%02x%02x'" % ((i,) + tuple(round(255 * c) for c in colour))
                           for i, colour in enumerate(colours)) + ")"


def compose(folder):
    """Both panels side by side, each over its scale of colours."""
    panel = """
set cbrange [0:{most}]; set cbtics {tics}; set cblabel '{label}' offset 0,0.6
set palette defined {palette}
set origin {left},0; set size 0.5,1
set colorbox horizontal user origin {bar},0.15 size 0.26,0.03
plot [0:{size}][0.12*{size}:0.88*{size}] '{file}' binary array=({size},{size}) format='%uchar' using 1:2:3 with rgbimage notitle, \\
     '+' using (-9):(-9):(0) with points palette notitle
"""
    commands = """
set encoding utf8
set terminal pngcairo size 940,450 font 'sans-serif,14' background '#ffffff'
unset border; unset xtics; unset ytics; set size ratio -1
set lmargin 0; set rmargin 0; set tmargin 0; set bmargin 4.6
set multiplot
"""
    for left, file, colours, most, tics, label in ((0, "grains.rgb", CONTACTS, 12, 3, "contacts of a grain"),
                                                   (0.5, "forces.rgb", FORCES, 4, 1, "force over mean force")):
        commands += panel.format(left=left, bar=left + 0.12, size=SIZE, file=folder + "/" + file, most=most,
                                 tics=tics, label=label, palette=palette(colours))
    return subprocess.run(["gnuplot"], input=commands.encode(), stdout=subprocess.PIPE, check=True).stdout


def main():
    snapshots = sys.argv[1] if len(sys.argv) > 1 else ROOT + "/out/d2/snapshots.h5"
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([ROOT + "/grainlaw", "export", snapshots, "-o", folder + "/packing.vtp"], check=True)
        draw(read_vtp(folder + "/packing.vtp"), folder)
        picture = compose(folder)
    with open(ROOT + "/docs/pictures/packing.png", "wb") as stream:
        stream.write(picture)


main()
