#!/usr/bin/env python3
"""Draws img-schematic.svg: a lamp's electrics. python3 tutorial/lamp/draw-schematic.py"""
import os

drawn = []


def line(*points):
    drawn.append('<polyline points="%s"/>' % " ".join(f"{x},{y}" for x, y in points))


def dot(x, y):
    drawn.append(f'<circle cx="{x}" cy="{y}" r="3" fill="black"/>')


def text(x, y, words, anchor="start"):
    drawn.append(f'<text x="{x}" y="{y}" text-anchor="{anchor}">{words}</text>')


def box(x, y, width, height, words=()):
    drawn.append(f'<rect x="{x}" y="{y}" width="{width}" height="{height}"/>')
    for k, each in enumerate(words):
        text(x + width / 2, y + height / 2 + 5 + 18 * (k - (len(words) - 1) / 2), each, "middle")


def ground(x, y):
    line((x, y), (x, y + 10))
    for k, half in enumerate((12, 8, 4)):
        line((x - half, y + 10 + 5 * k), (x + half, y + 10 + 5 * k))


def mosfet(x, y):
    """Its gate at (x, y), drain at (x + 40, y - 40), source at (x + 40, y + 40)."""
    line((x, y), (x + 15, y))
    line((x + 15, y - 18), (x + 15, y + 18))
    for part in (-15, 0, 15):
        line((x + 22, y + part - 6), (x + 22, y + part + 6))
    line((x + 22, y - 15), (x + 40, y - 15), (x + 40, y - 40))
    line((x + 22, y + 15), (x + 40, y + 15), (x + 40, y + 40))
    line((x + 22, y), (x + 40, y), (x + 40, y + 15))
    line((x + 32, y - 5), (x + 24, y), (x + 32, y + 5))
    dot(x + 40, y + 15)


# The supply and the panel.
text(20, 36, "24 V")
drawn.append('<circle cx="30" cy="60" r="4"/>')
line((34, 60), (90, 60))
box(90, 50, 60, 20, ("F1 2 A",))
line((150, 60), (560, 60))
dot(230, 60)
dot(560, 60)
line((560, 60), (560, 90))
box(510, 90, 100, 50, ("LED panel", "24 V, 20 W"))
line((560, 140), (560, 205))
mosfet(520, 245)
text(575, 250, "Q1 IRLZ44N")
line((560, 285), (560, 330))
ground(560, 330)

# The controller.
line((230, 60), (230, 110))
box(180, 110, 100, 45, ("24 V to 5 V", "0.5 A"))
text(290, 138, "buck converter")
line((230, 155), (230, 190))
box(170, 190, 120, 110, ("Arduino", "Nano"))
text(236, 184, "5V")
text(284, 250, "D9", "end")
text(236, 316, "GND")
line((230, 300), (230, 330))
ground(230, 330)
line((290, 245), (400, 245))
box(400, 235, 60, 20, ("R1 220",))
line((460, 245), (520, 245))
dot(340, 245)
line((340, 245), (340, 265))
box(330, 265, 20, 45)
text(358, 300, "R2 10 k")
line((340, 310), (340, 330))
ground(340, 330)

# What the cable to the supply does not give quickly.
dot(430, 60)
line((430, 60), (430, 100))
line((412, 100), (448, 100))
text(436, 94, "+")
text(456, 112, "C1", "start")
line((412, 108), (448, 108))
line((430, 108), (430, 150))
ground(430, 150)
text(60, 250, "USB")
line((95, 245), (170, 245))

with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "img-schematic.svg"), "w", encoding="utf-8") as file:
    file.write('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 700 370" width="700" height="370">\n'
               '<rect width="700" height="370" fill="white"/>\n'
               '<g fill="none" stroke="black" stroke-width="1.5">\n')
    for element in drawn:
        style = ' font-family="sans-serif" font-size="14" fill="black" stroke="none"' if element.startswith("<text") else ""
        file.write(element.replace("<text", "<text" + style, 1) + "\n")
    file.write("</g>\n</svg>\n")
