# GPL v2 or later, see LICENSE.
"""Crush a cylinder of bonded spheres in a flexible jacket, and look at the membrane: a triaxial test.

Run:      scripts/ddem run scripts/jacketed_cylinder.py                  (half a minute)
          scripts/ddem run scripts/jacketed_cylinder.py --pressure 5e6
          scripts/ddem run scripts/jacketed_cylinder.py --help           (all options)
Writes:   a line here, and in out/jacketed_cylinder: jacket.png, the membrane and a cut through the sample at its
          largest stress and at the end, and curve.csv.

            | | |      A cylinder 12 mm wide and 16 mm tall of a thousand spheres. Servo walls and the jacket bring it
           _v_v_v_     to the pressure first; then the walls approach, and the jacket keeps it.
        p ->|     |<-
        p ->|     |<-  The membrane has no stiffness. Its nodes move with the spheres next to them, and hand on to these
        p ->|_____|<-  the pressure on their present area.
            ^ ^ ^

Expect:   110 MPa at 20 MPa of pressure. The membrane follows spheres that come loose, and dents.
"""
import os

import numpy as np

from yade import BondedMat, O, ddem
from yade.ddem import plots, provenance
from yade.ddem.series import Series
from yade.ddem.studies import commandline

RADIUS, LENGTH = 6e-3, 16e-3  # [m]
STEPS = 100  # looks at the stress


@commandline.steps_told()
def main():
	options = read_options()
	sample = make(options)
	test = ddem.bonded.triaxial(
		sample, options.pressure, options.strain, duration=options.strain * LENGTH / (2 * options.velocity),
		velocity=4 * options.velocity, sides="jacket"
	)
	O.engines = ddem.bonded.engines(test, viscosity=1e4)
	O.dt = ddem.bonded.time_step(0.6)
	ddem.bonded.check()
	series, looks = crush(test)
	series.write(os.path.join(options.out, "curve.csv"))
	plots.save(figure(looks), os.path.join(options.out, "jacket.png"))
	print(f"{max(series['stress']) / 1e6:.1f} MPa at a pressure of {options.pressure / 1e6:g} MPa; {options.out}")


def make(options):
	"""The sample in the scene."""
	O.reset()
	O.materials.append(BondedMat(label="rock", young=50e9, cohesion=options.cohesion))
	shape = ddem.packing.Cylinder((0, 0, 0), (0, LENGTH, 0), RADIUS)
	return ddem.bonded.append(ddem.packing.fill(shape, options.rmin, 2.5 * options.rmin, options.seed), "rock")


class Look:
	"""What a picture needs: the membrane, and the spheres, at one strain."""

	def __init__(self, test):
		self.strain, self.stress = test.strain, test.stress
		self.nodes, self.faces = test.confinement.mesh
		self.centres, self.radii, self.damage = test.sample.positions, test.sample.radii, test.sample.damage


def crush(test):
	"""Stress and volume over strain, and looks at the start, the largest stress and the end."""
	series = Series(strain="-", stress="Pa", volumetric_strain="-", broken="-")
	first = strongest = Look(test)
	duration = sum(test.engines[0].durations)
	for _ in range(STEPS):
		O.run(max(1, round(duration / O.dt / STEPS)), True)
		series.append(
			strain=test.strain, stress=test.stress,
			volumetric_strain=test.confinement.volumetric_strain, broken=test.sample.broken_fraction
		)
		if test.stress > strongest.stress:
			strongest = Look(test)
	return series, [first, strongest, Look(test)]


def figure(looks):
	"""The membrane from the side, coloured by how far it has come in, and a cut at half height."""
	from matplotlib import pyplot
	from matplotlib.collections import PatchCollection
	from matplotlib.patches import Circle
	from mpl_toolkits.mplot3d.art3d import Poly3DCollection
	first, shown = looks[0], looks[1:]
	drawing = pyplot.figure(figsize=(8, 7))
	for column, look in enumerate(shown):
		inward = np.hypot(*first.nodes[:, [0, 2]].T) - np.hypot(*look.nodes[:, [0, 2]].T)
		above = drawing.add_subplot(2, 2, column + 1, projection="3d")
		skin = Poly3DCollection(1e3 * look.nodes[look.faces][:, :, [0, 2, 1]], edgecolor="0.4", linewidth=0.2)
		skin.set_array(1e3 * inward[look.faces].mean(axis=1))
		skin.set_cmap("RdBu_r")
		skin.set_clim(-0.5, 0.5)
		above.add_collection3d(skin)
		above.set(
			xlim=(-6, 6), ylim=(-6, 6), zlim=(0, 16), box_aspect=(12, 12, 16), xlabel="x [mm]",
			ylabel="z [mm]", zlabel="y [mm]", title=f"{1e-6 * look.stress:.0f} MPa at a strain of "
			f"{100 * look.strain:.2f} %"
		)
		drawing.colorbar(skin, ax=above, shrink=0.6, pad=0.14, label="membrane inwards [mm]")
		below = drawing.add_subplot(2, 2, column + 3, aspect="equal", xlabel="x [mm]", ylabel="z [mm]")
		height = LENGTH / 2
		cut = look.radii**2 - (look.centres[:, 1] - height)**2
		spheres = PatchCollection(
			[
				Circle(1e3 * place, 1e3 * radius)
				for place, radius in zip(look.centres[cut > 0][:, [0, 2]], np.sqrt(cut[cut > 0]))
			], cmap="viridis", edgecolor="0.3", linewidth=0.3
		)
		spheres.set_array(look.damage[cut > 0])
		spheres.set_clim(0, 1)
		below.add_collection(spheres)
		around = int(np.isclose(first.nodes[:, 1], first.nodes[0, 1], atol=1e-9).sum())
		rows = look.nodes.reshape(-1, around, 3)
		ring = rows[abs(rows[:, :, 1].mean(axis=1) - height).argmin()]
		below.plot(*1e3 * np.vstack([ring, ring[:1]])[:, [0, 2]].T, "r.-", linewidth=1, markersize=3)
		below.set(xlim=(-7, 7), ylim=(-7, 7), title="at half height, membrane red")
		drawing.colorbar(spheres, ax=below, shrink=0.8, label="broken bonds of a sphere [-]")
	drawing.tight_layout()
	return drawing


def read_options():
	parser = commandline.script_parser(
		"jacketed_cylinder", "Crush a cylinder of bonded spheres in a flexible jacket."
	)
	add = parser.add_argument
	add("--pressure", type=commandline.positive, default=20e6, metavar="PA", help="of the jacket [Pa]")
	add("--strain", type=commandline.positive, default=0.01, metavar="STRAIN", help="at the end [-]")
	add("--velocity", type=commandline.positive, default=0.5, metavar="M/S", help="of each wall, about [m/s]")
	add("--cohesion", type=commandline.positive, default=120e6, metavar="PA", help="of the bonds [Pa]")
	add("--rmin", type=commandline.positive, default=0.45e-3, metavar="M", help="smallest of radii of 1 to 2.5 [m]")
	add("--seed", type=commandline.seed, default=1, metavar="N", help="of the packing")
	add("--out", default=os.path.join("out", "jacketed_cylinder"), metavar="DIR", help="folder for all files")
	options = parser.parse_args()
	provenance.begin(vars(options))
	commandline.require_writable(parser, "--out", options.out)
	return options


if __name__ == "__main__":
	main()
