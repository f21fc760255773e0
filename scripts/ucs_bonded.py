# GPL v2 or later, see LICENSE.
"""Crush, pull apart, confine, split, bend or shear one sample of bonded spheres: generated, or from files.

Run:      scripts/ddem run scripts/ucs_bonded.py                    (compression, consistent bonds, rock density;
                                                                    a quarter of a minute)
          scripts/ddem run scripts/ucs_bonded.py --convention esys  (bonds, contacts,
                                                                    walls and masses of ESyS-Particle's tutorial)
          scripts/ddem run scripts/ucs_bonded.py --test tension
          scripts/ddem run scripts/ucs_bonded.py --test triaxial --pressure 20e6           (or oedometer)
          scripts/ddem run scripts/ucs_bonded.py --test brazilian --jaws curved --size 0.03 0.03 0.01
          scripts/ddem run scripts/ucs_bonded.py --test bending --notch 0.003 --generator fill
          scripts/ddem run scripts/ucs_bonded.py --test shear --normal-stress 20e6
          scripts/ddem run scripts/ucs_bonded.py --shape cylinder --criterion softening --scatter 8
          scripts/ddem run scripts/ucs_bonded.py --particles P.csv --bonds B.csv --length-unit mm
          scripts/ddem run scripts/ucs_bonded.py --help             (every parameter of model and test)
Writes:   a table here, and into out/ucs_bonded: report.html with pictures, summary.json, rigid.csv (time series),
          rigid_broken_bonds.csv (a line a broken bond), and ParaView files of spheres, bonds and broken bonds.

        v |  0.125 m/s      The uniaxial test of Weatherley et al. (tutorial of ESyS-Particle): spheres of 0.4 to 2 mm
     =============          packed into a prism of 10 x 20 x 10 mm, bonded where they touch, between two elastic walls
      o O o O O o           that push (spring pi r K on a sphere of radius r, no friction), or, in tension, hold the
      O o O O o O           spheres at both ends and pull. Stress is (F_top + F_bottom)/2A (eq. 9), strain the approach
      o O o O o o           of the walls over their first distance (eqs. 10-11), A the face of the box. Strength is the
     =============          largest stress, Young's modulus the least-squares slope between 20 % and 60 % of it.
        v ^                 In tension stress, strain and forces count positive in tension;
                            a bond's normal stress always does.

                            SI units everywhere, but for files of particles, which have --length-unit.

Expect:   690 spheres, 2190 bonds. Compression: 136 MPa and 112 GPa; a band of broken bonds crosses the sample, three in
          four of them broken in tension. In esys, with spheres 92 times as heavy: 186 MPa, as half the bending moment
          means less tension, and inertia holds the fragments together. Tension: 51 MPa and 114 GPa; one crack goes
          straight across. Another --seed changes strengths by a tenth or two.
"""
import os
import time

from yade import ddem
from yade.ddem import vtk
from yade.ddem.reports import bonded_test
from yade.ddem.reports.uniaxial import Report
from yade.ddem.studies import bonded_specimen, commandline
from yade.ddem.studies.bonded_options import read_options
from yade.ddem.studies.bonded_tests import TESTS


@commandline.steps_told()
def main():
	options, parser = read_options()
	try:
		commandline.restart(options.threads)
		start = time.perf_counter()
		platens, critical, sample = make(options)
		ddem.bonded.check()
	except (ValueError, OSError, ImportError, RuntimeError) as error:
		parser.error(str(error))
	recorders = (
		[vtk.Recorder(platens.sample, os.path.join(options.out, "paraview", "rigid"))] if options.vtk else []
	)
	kind = TESTS[options.test]
	test = kind.record(
		platens, kind.duration(options, platens), stop=options.stop, recorders=recorders, critical_dt=critical,
		rows=options.rows,
		snapshots=options.pictures
	)
	setup = time.perf_counter() - start
	run = test.run(progress=options.progress)
	run.setup, run.parameters = setup, sample
	run.extra.update(bonded_specimen.waves(platens.sample, run))
	run.extra.update(kind.figures(run, platens))
	report = Report(
		[run], options.out, kind.title(), settings=bonded_test.settings(options, platens),
		command=commandline.command(),
		options=commandline.plain(options), versions=versions(), notes=bonded_test.notes(options, platens, run),
		pictures=options.pictures, pdf=options.pdf
	)
	page = report.write()
	print(f"\n{report.table()}\n\nReport: {page}")


def make(options):
	"""Spheres, bonds, walls and engines in the scene; the walls, the critical time step,
	and what the report says about the sample."""
	O.reset()
	kind = TESTS[options.test]
	packing = kind.packing(options, bonded_specimen.read_packing(options))
	sample = bonded_specimen.append(options, packing)
	platens, loads = kind.load(options, sample)
	O.engines = ddem.bonded.engines(loads, options.viscosity, options.rotational_viscosity, options.convention)
	critical = ddem.bonded.critical_time_step()
	O.dt = options.dt or options.safety * critical
	rows = bonded_test.sample_rows(
		options, packing, sample.initial_bonds, O.materials["bonds"], O.dt, critical
	)
	return platens, critical, rows


def versions():
	import matplotlib
	import numpy
	from vtkmodules.vtkCommonCore import vtkVersion
	return {**commandline.versions(numpy, matplotlib), "VTK": vtkVersion.GetVTKVersion()}


if __name__ == "__main__":
	main()
