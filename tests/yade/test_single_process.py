# GPL v2 or later, see LICENSE.
"""Both models run in one process: under mpirun with more they refuse in words; what else mpirun starts, runs."""
import os
import shutil
import subprocess

import pytest

from yade import (
	BondedMat, Ip2_BondedMat_BondedMat_BondedPhys, Law2_ScGeom_BondedPhys_Bonded, NewtonIntegrator, O,
	Subdomain, ddem, utils
)
from yade.ddem import bonded

from deformable_samples import elastic, skewed_mesh, start

REFUSAL = "not under mpirun yet"

SAMPLES = {
	"triangles": """
O.materials.append(DeformableElastMat(bulk=30e9, shear=26e9, density=2400, label="rock"))
ddem.append(ddem.mesh.rectangle(0.1, 0.2, nx=4, ny=8), "rock")
""",
	"bonds": """
O.materials.append(BondedMat(label="rock"))
spheres = [utils.sphere((2e-3 * i, 2e-3 * j, 0), 1e-3, material="rock") for i in range(4) for j in range(8)]
ids = O.bodies.append(spheres)
Ip2_BondedMat_BondedMat_BondedPhys().bond([(i, j) for i in ids for j in ids if i < j and (
	O.bodies[i].state.pos - O.bodies[j].state.pos).norm() < 2.1e-3])
""",
}
SAMPLES["bonds one by one"] = SAMPLES["bonds"]
SPHERES = "[Ig2_Sphere_Sphere_ScGeom()]"
BONDED = f"({SPHERES}, [Ip2_BondedMat_BondedMat_BondedPhys()], [Law2_ScGeom_BondedPhys_Bonded()])"
FRICTIONAL = f"({SPHERES}, [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()])"
COLLIDER = "ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb()], label='collider'),"
ENGINES = {
	"triangles": f"[{COLLIDER} DeformableEngine(), NewtonIntegrator()]",
	"bonds": f"[{COLLIDER} BondedInteractionLoop{BONDED}, NewtonIntegrator(damping=0)]",
	"bonds one by one": f"[{COLLIDER} InteractionLoop{BONDED}, NewtonIntegrator(damping=0)]",
}


RUN = """
for _ in range(5):
	O.step()  # O.run would miss an error that comes before it starts to wait
print("HAS RUN", O.iter, flush=True)
"""
DIVIDED_RUN = """
mp.DOMAIN_DECOMPOSITION = True
mp.mpirun(5, mp.numThreads, True)
print("HAS RUN", O.iter, flush=True)
"""


def scene(model):
	return f"from yade import ddem\n{SAMPLES[model]}\nO.engines = {ENGINES[model]}\nO.dt = 1e-9\n"


def divided_scene(model):
	"""Made by the master alone, to be divided by mpy."""
	sample = SAMPLES[model].strip().replace("\n", "\n\t")
	made = f"from yade import ddem\nfrom yade import mpy as mp\nif mp.rank == 0:\n\t{sample}\n"
	return f"{made}O.engines = {ENGINES[model]}\nO.dt = 1e-9\n"


@pytest.fixture
def yade(tmp_path):
	"""Runs YADE scripts, by mpirun where a number of processes is given."""
	ours = ("OMPI_", "PMI", "PRTE_", "MV2_", "SLURM_")
	environment = {name: value for name, value in os.environ.items() if not name.startswith(ours)}
	environment.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMPI_MCA_btl="self,sm")

	def run(text, processes=None):
		(tmp_path / "script.py").write_text(text)
		command = [shutil.which("yade"), "-n", "-x", "-j1", "script.py"]
		if processes:
			command = ["mpirun", "--oversubscribe", "-n", str(processes)] + command
		done = subprocess.run(
			command, cwd=tmp_path, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
			stderr=subprocess.STDOUT,
			text=True, env=environment
		)
		return done.returncode, done.stdout

	return run


@pytest.mark.parametrize("model", sorted(SAMPLES))
def test_refuses_under_mpirun(yade, model):
	code, text = yade(scene(model) + RUN, processes=2)
	assert code != 0 and "HAS RUN" not in text
	assert REFUSAL in text and "one of 2" in text and "yade -jN" in text


@pytest.mark.parametrize("model", sorted(SAMPLES))
def test_refuses_to_be_divided(yade, model):
	"""All processes end: none waits for one that has refused."""
	code, text = yade(divided_scene(model) + DIVIDED_RUN, processes=3)
	assert code != 0 and "HAS RUN 5" not in text
	assert REFUSAL in text and "one of 3" in text


def test_runs_as_the_only_process_of_mpirun(yade):
	code, text = yade("O.reset()\n".join(scene(model) + RUN for model in sorted(SAMPLES)), processes=1)
	assert code == 0 and text.count("HAS RUN 5") == 3, text


@pytest.mark.parametrize("model", ["triangles", "bonds one by one"])
def test_loaded_scene_is_refused(yade, tmp_path, model):
	exec("from yade import *\n" + scene(model))
	O.step()
	O.save(str(tmp_path / "scene.yade.gz"))
	code, text = yade("O.load('scene.yade.gz')\n" + RUN, processes=2)
	assert code != 0 and "HAS RUN" not in text and REFUSAL in text


def test_other_scenes_run_under_mpirun(yade):
	spheres = "O.bodies.append([utils.sphere((0, 0, 0), 1), utils.sphere((1.9, 0, 0), 1)])\n"
	engines = f"O.engines = [{COLLIDER} InteractionLoop{FRICTIONAL}, NewtonIntegrator()]\n"
	code, text = yade(spheres + engines + RUN, processes=2)
	assert code == 0 and text.count("HAS RUN 5") == 2, text


# --- without mpirun: what its launchers leave in the environment, and scenes that mpy has divided


def triangles():
	ddem.append(skewed_mesh(), elastic())
	start()


def pair():
	O.materials.append(BondedMat(label="rock"))
	return O.bodies.append([utils.sphere((2e-3 * i, 0, 0), 1e-3, material="rock") for i in range(2)])


def bonds():
	Ip2_BondedMat_BondedMat_BondedPhys().bond([tuple(pair())])
	O.engines = bonded.engines()
	O.dt = 1e-9


@pytest.mark.parametrize("name", ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE"])
@pytest.mark.parametrize("make", [triangles, bonds])
def test_launchers_say_how_many_they_have_started(monkeypatch, make, name):
	make()
	monkeypatch.setenv(name, "4")
	with pytest.raises(RuntimeError, match=f"{REFUSAL}.*one of 4.*yade -jN"):
		O.step()
	monkeypatch.setenv(name, "1")
	O.step()


@pytest.mark.parametrize("make", [triangles, bonds])
def test_tasks_of_slurm_are_not_counted(monkeypatch, make):
	"""They are those of the allocation, also for a single process in it."""
	monkeypatch.setenv("SLURM_NTASKS", "8")
	make()
	O.step()


def test_bonds_are_not_even_made(monkeypatch):
	monkeypatch.setenv("OMPI_COMM_WORLD_SIZE", "2")
	ids = pair()
	with pytest.raises(RuntimeError, match=REFUSAL):
		Ip2_BondedMat_BondedMat_BondedPhys().bond([tuple(ids)])
	assert O.interactions.countReal() == 0
	with pytest.raises(RuntimeError, match=REFUSAL):
		Law2_ScGeom_BondedPhys_Bonded(convention="esys")


@pytest.mark.parametrize("divide", ["number", "subdomain"])
@pytest.mark.parametrize("make", [triangles, bonds])
def test_divided_scene_is_refused(make, divide):
	make()
	O.step()
	if divide == "number":
		O._sceneObj.subdomain = 1
	O._sceneObj.subD = Subdomain()
	O.engines = O.engines + [NewtonIntegrator(dead=True)]  # as mpy does when it divides a scene
	with pytest.raises(RuntimeError, match=f"{REFUSAL}.*divided into subdomains.*yade -jN"):
		O.step()


def test_divided_scene_is_refused_by_a_plain_interaction_loop(yade):
	code, text = yade(scene("bonds one by one") + RUN + "O._sceneObj.subD = Subdomain()\n" + RUN)
	assert code != 0 and text.count("HAS RUN") == 1 and REFUSAL in text
