# GPL v2 or later, see LICENSE.
"""Break a bar by its own reflected wave: spall, and what the velocity of the free end tells about it.

Run:      scripts/ddem run scripts/spall_bar.py                   (five seconds)
          scripts/ddem run scripts/spall_bar.py --help            (all options)
Writes:   a table here, and in out/spall_bar: spall.png, a CSV of the free end's velocity, and bar.pvd for ParaView.

        -> |o o o o o o o o o o o o o o o|          A bar of concrete, 0.4 m long, whose long sides slide on rollers:
     v(t)  |                             | free     plane waves, as in plate impact. The left end moves as v sin²(π t/40
        -> |o o o o o o o o o o o o o o o|          µs), 8 m/s at most, a pulse of 100 MPa, and stops. The pulse comes
                                                    back from the free end as tension.
                                                    The same is done with elastic concrete.

Expect:   the elastic bar returns the pulse whole: Novikov's ½ ρ c Δu_fs gives its largest tension to 0.02 %. Concrete
          bears 19 MPa, and breaks in three planes 5 to 7 cm from the free end, just beyond cT/4 = 52 mm, the nearest
          place that feels the whole pulse; what is beyond flies off with part of the pulse. ½ ρ c Δu_fs gives 38 MPa,
          and is no spall strength here: the formula takes the bar to be elastic until it breaks at once, but this law
          flows at any tension. Of the 38, 29 belong to the fall between the two characteristics through the largest
          tension, and 10 of these are flow on the way (29 − 10 = 19); the other 9 come later, from a wide zone that
          flows and pulls. The brittler, the closer: 6.5 and 5.6 MPa with --energy 1e3 --speed 4.
"""
import os

import numpy as np

from yade import O
from yade.ddem import plots, provenance, vtk
from yade.ddem.series import Series
from yade.ddem.studies import commandline
from yade.ddem.studies.structures import spall, spall_figures


@commandline.steps_told()
def main():
	options = read_options()
	settings = {
		"speed": options.speed,
		"duration": options.duration,
		"length": options.length,
		"size": options.size,
	}
	elastic = spall.run(effects=spall.OFF, **settings)
	O.reset()
	recorders = [lambda block: vtk.Recorder(block, os.path.join(options.out, "bar"))] if options.vtk else []
	broken = spall.run(effects={"fractureEnergy": options.energy}, recorders=recorders, **settings)
	units = {"time": "s", "concrete": "m/s", "elastic": "m/s"}
	Series.of(units, time=broken.times, concrete=broken.surface, elastic=elastic.surface).write(
		os.path.join(options.out, "free_end.csv")
	)
	plots.save(spall_figures.history(broken, elastic), os.path.join(options.out, "spall.png"))
	print(f"\n{'':<48}{'elastic':>12}{'concrete':>12}")
	for name, text in (
		("largest compression [MPa]", lambda one: f"{-one.stress.min() / 1e6:.1f}"),
		("largest tension [MPa]", lambda one: f"{one.stress.max() / 1e6:.2f}"),
		("   at x [mm]", lambda one: f"{1e3 * one.places[one.tension[2]]:.0f}"),
		("½ ρ c Δu_fs, highest to lowest [MPa]", lambda one: f"{one.spall_stress / 1e6:.2f}"),
		("½ ρ c Δu, between the two characteristics [MPa]", lambda one: f"{one.matched_stress[0] / 1e6:.2f}"),
		("   of that by flow on their way [MPa]", lambda one: f"{one.matched_stress[1] / 1e6:.2f}"),
		("velocity of the free end, highest [m/s]", lambda one: f"{one.pullback[0][0]:.2f}"),
		("   and lowest after that [m/s]", lambda one: f"{one.pullback[0][1]:.2f}"),
		("largest damage [-]", lambda one: f"{one.damage[-1].max():.2f}"),
		(
			"   at x [mm]",
			lambda one: (
				f"{1e3 * one.places[one.damage[-1].argmax()]:.0f}"
				if one.damage[-1].max() > 0.01
				else "-"
			),
		),
		(
			"   centre, from the free end [mm]",
			lambda one: f"{1e3 * one.damage_depth:.0f}" if one.damage[-1].max() > 0.01 else "-",
		),
		("error of the energy book", lambda one: f"{one.energy_error:.0e}"),
	):
		print(f"{name:<48}{text(elastic):>12}{text(broken):>12}")
	print(f"\nPictures and files: {options.out}")


def read_options():
	"""Options from the command line; complains about them before anything runs."""
	parser = commandline.script_parser("spall_bar", "Break a bar by its own reflected wave.")
	parser.add_argument(
		"--speed", type=float, default=8.0, metavar="M/S",
		help="largest speed of the driven end; the pulse has the stress ρ c times that"
	)
	parser.add_argument("--duration", type=float, default=40e-6, metavar="S", help="of the pulse [s]")
	parser.add_argument(
		"--energy", type=float, default=80e3, metavar="J/M3", help="fracture energy per volume [J/m³]"
	)
	parser.add_argument("--length", type=float, default=0.4, metavar="M", help="of the bar [m]")
	parser.add_argument("--size", type=float, default=0.004, metavar="M", help="of the cells [m]")
	commandline.add_files(parser, "spall_bar", "ParaView files of the bar of concrete")
	options = parser.parse_args()
	provenance.begin(vars(options))
	for name in ("speed", "duration", "energy", "length", "size"):
		if not 0 < getattr(options, name) < np.inf:
			parser.error(f"argument --{name}: {getattr(options, name):g} must be positive")
	if options.size > options.length / 20:
		parser.error(
			f"argument --size: {options.size:g} m is more than a twentieth of the bar, {options.length:g} m"
		)
	if spall.WAVE * options.duration > options.length:
		parser.error(
			f"argument --duration: the pulse is {spall.WAVE * options.duration:.2g} m long, more than the "
			f"bar of {options.length:g} m"
		)
	commandline.require_writable(parser, "--out", options.out)
	return options


if __name__ == "__main__":
	main()
