# GPL v2 or later, see LICENSE.
"""Crush, pull, confine, bend, split or shear one sample of deformable triangles.

Run:      scripts/ddem run scripts/ucs_deformable.py                   (compression of concrete; some ten seconds)
          scripts/ddem run scripts/ucs_deformable.py --test tension    (or oedometer, bending, shear, brazilian)
          scripts/ddem run scripts/ucs_deformable.py --test biaxial --pressure 10e6
          scripts/ddem run scripts/ucs_deformable.py --test brazilian --jaws curved --law scalar-damage
          scripts/ddem run scripts/ucs_deformable.py --law von-mises --yield-stress 300e6 --ends smooth
          scripts/ddem run scripts/ucs_deformable.py --help             (every parameter of law, sample and test)
Writes:   a table here, and into out/ucs_deformable: report.html with pictures, summary.json, deformable.csv
          (time series), and ParaView files.

        v |            The sister of ucs_bonded.py, with the other model: the same kinds of tests, the same report, the
     ===========       same names in summary.json. Triangles are in plane strain, so moduli are those of plane strain:
     |         |       the report has the slope of an elastic sample beside the measured one.
     |         |       A test is a module of studies.deformable_tests, and one call in a scene: ddem.platens,
     |         |       ddem.oedometer, ddem.biaxial, ddem.three_point_bending, ddem.brazilian, ddem.simple_shear.
     ===========       Stress, strain and forces count positive as the test loads.
        v ^

Expect:   1900 triangles of Zubelewicz's concrete: 72 MPa and 54 GPa in compression, 8.8 MPa in tension (strain rates of
          10 and 0.5 /s: it is the stronger the faster), 116 MPa under 10 MPa of pressure, 18 MPa in bending, 11 MPa
          between flat jaws. In an oedometer (431 MPa at 0.5 %) and in shear at constant volume (119 MPa at 1 %) it
          does not fail. With --law scalar-damage 3.13 MPa in tension, f_t/(1 − ν²), 6.3 MPa in bending, where one
          crack grows to the load, and 2.3 MPa between flat jaws, where the disc splits from its centre.
"""
import os
import time

from yade import DeformableEngine, DeformableTimeStepper, ForceResetter, O, ddem
from yade.ddem import vtk
from yade.ddem.reports import deformable_test
from yade.ddem.reports.uniaxial import Report
from yade.ddem.studies import commandline, deformable_laws
from yade.ddem.studies.deformable_options import read_options
from yade.ddem.studies.deformable_tests import TESTS


@commandline.steps_told()
def main():
	options, parser = read_options()
	try:
		commandline.restart(options.threads)
		start = time.perf_counter()
		load, critical, material = make(options)
	except (ValueError, OSError, ImportError, RuntimeError) as error:
		parser.error(str(error))
	kind = TESTS[options.test]
	recorders = (
		[vtk.Recorder(load.sample, os.path.join(options.out, "paraview", "deformable"))] if options.vtk else []
	)
	test = kind.record(
		load, kind.duration(options, load), stop=options.stop, recorders=recorders, critical_dt=critical,
		rows=options.rows, snapshots=options.pictures
	)
	setup = time.perf_counter() - start
	run = test.run(progress=options.progress)
	run.setup, run.parameters = setup, deformable_test.sample_rows(options, load.sample, material, run.dt)
	modulus = kind.elastic_modulus(load, material.young, material.poisson)
	run.extra.update({"elastic_modulus_GPa": modulus and 1e-9 * modulus, **kind.figures(run, load)})
	report = Report(
		[run], options.out, kind.title(), settings=deformable_test.settings(options, load),
		command=commandline.command(), options=commandline.plain(options), versions=versions(),
		notes=deformable_test.notes(options, load, material, run), pictures=options.pictures, pdf=options.pdf
	)
	page = report.write()
	print(f"\n{report.table()}\n\nReport: {page}")


def make(options):
	"""The block, its loads and engines in the scene; the loads, the critical time step and the material."""
	O.reset()
	kind = TESTS[options.test]
	material = deformable_laws.append(options)
	block = ddem.append(
		kind.mesh(options), kind.materials(material), seed=options.seed if options.spread else None,
		spread=options.spread, thickness=options.size[2], initial_stress=kind.initial_stress(options)
	)
	load = kind.load(options, block)
	engine = DeformableEngine(rotation=options.rotation, damping=options.damping or -1, label="triangles")
	O.engines = [ForceResetter(), *load.engines, DeformableTimeStepper(safety=options.safety), engine]
	critical = engine.criticalTimeStep()
	O.dt = options.safety * critical
	return load, critical, material


def versions():
	import matplotlib
	import numpy
	from vtkmodules.vtkCommonCore import vtkVersion
	return {**commandline.versions(numpy, matplotlib), "VTK": vtkVersion.GetVTKVersion()}


if __name__ == "__main__":
	main()
