# GPL v2 or later, see LICENSE.
"""Where a result comes from: versions, command, seed and a hash of the inputs, in every file that the package writes.

Scripts need to do nothing: the script itself, the meshes and packings that it reads and the seeds that it draws from
are noted on the way, and all writers of the package add :func:`record`.
What else a result depends on is named by hand::

	from yade.ddem import provenance

	provenance.begin({"load": 10}, seed=3)  # parameters of this run; forgets what earlier runs of the process read
	provenance.note_file("measured.csv")  # a file that the script reads by itself
	provenance.write_json("result.json", {"strength_MPa": 71.2})
	provenance.read("result.json")["inputs_sha256"]

The same script with the same parameters, seeds and files has the same ``inputs_sha256``, whenever and wherever it runs.
Needs no YADE. Limit: modules that a script imports from beside it are files to be named.
"""
import contextlib
import csv
import datetime
import functools
import hashlib
import json
import os
import pathlib
import platform
import re
import shlex
import sys

KEY = "provenance"  #: of JSON files, of VTK's field data, of the comment in CSV files
#: options of scripts that change no number: which files are written and where, and how many threads work
NO_INPUT = {"out", "report", "json", "pictures", "pdf", "vtk", "progress", "threads", "jobs", "cluster"}
_HERE = pathlib.Path(__file__).resolve().parent


class _Run:
	"""What is known of the run that this process is at."""

	def __init__(self, parameters=None, seed=None):
		self.parameters, self.seed = parameters, seed
		self.files, self.seeds = {}, []  # files as a dict: in order, once each

	@functools.cached_property
	def parameters_sha256(self):
		return _sha256(_text(self.parameters).encode())


_run = _Run()


def begin(parameters=None, seed=None):
	"""Begin a run: files and seeds that were noted before are forgotten.

	:param parameters: options by name, as ``vars(options)`` of argparse, without those of :data:`NO_INPUT`.
		None: the arguments of the command line
	:param seed: a number, or several; None: the parameter "seed" or "seeds", else the seeds that the run draws from
	"""
	global _run
	if parameters is not None:
		parameters = {name: value for name, value in parameters.items() if name not in NO_INPUT}
		if seed is None:
			seed = parameters.get("seed", parameters.get("seeds"))
	_run = _Run(parameters, seed)


def note_file(path):
	"""Note a file that the run reads."""
	_run.files[os.path.abspath(path)] = None


def note_seed(seed):
	"""Note a seed that the run draws from; None, where nothing is drawn, is ignored."""
	if seed is not None and seed not in _run.seeds:
		_run.seeds.append(seed)


def record(inputs=(), seed=None):
	"""Where a result that is written now comes from, as plain data.

	:param inputs: further files that it depends on
	:param seed: in the place of what is known of the run
	:returns: dict of ``plugin`` (version, git revision of the build, hash of its code), ``versions`` (YADE, Python,
		numpy), ``machine`` (system, processor, cores, threads), ``written`` (UTC), ``command``, ``seed``,
		``parameters_sha256``, ``files`` (names and SHA-256) and ``inputs_sha256``, of parameters, seed and
		files; None where there is no such thing
	:raises OSError: a file that was noted cannot be read any more
	"""
	seed = seed if seed is not None else _run.seed if _run.seed is not None else _several(_run.seeds)
	seed = _plain(seed)
	given = _run.parameters is not None
	parameters = _run.parameters_sha256 if given else _sha256(_text(sys.argv[1:]).encode())
	paths = dict.fromkeys([*_script(), *_run.files, *map(os.path.abspath, inputs)])
	files = [{"file": _shown(path), "sha256": _file_sha256(path)} for path in paths]
	inputs = [parameters, seed, sorted([os.path.basename(one["file"]), one["sha256"]] for one in files)]
	return {
		"plugin": plugin(),
		"versions": _versions(),
		"machine": {**machine(), "threads": _threads()},
		"written": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
		"command": command(),
		"seed": seed,
		"parameters_sha256": parameters,
		"files": files,
		"inputs_sha256": _sha256(_text(inputs).encode()),
	}


# ---- files ----


def text(found=None):
	"""The record, or one that is there already, in one line of ASCII."""
	return json.dumps(found or record())


def write_json(path, data, **options):
	"""Write a dict, or a list of them, to a JSON file, each with the record under "provenance".

	*options* are those of json.dumps. Nothing is written where the data cannot be.
	"""
	origin = {KEY: record()}
	known = {**data, **origin} if isinstance(data, dict) else [{**one, **origin} for one in data]
	lines = json.dumps(known, **options)
	with open(path, "w", encoding="utf-8") as file:
		file.write(lines + "\n")


@contextlib.contextmanager
def csv_writer(path):
	"""A csv.writer to a file that ends with the record, in a line that begins with "#".

	It stands at the end, because readers such as numpy.genfromtxt(names=True) and spreadsheets take the names of
	columns from the first line.
	"""
	with open(path, "w", newline="", encoding="utf-8") as file:
		yield csv.writer(file)
		file.write(f"# {KEY}: {text()}\n")


def csv_rows(file):
	"""Line numbers and cells of an open CSV file, without the lines that begin with "#"."""
	reader = csv.reader(file)
	for cells in reader:
		if not (cells and cells[0].startswith("#")):
			yield reader.line_num, cells


def metadata(ending):
	"""What matplotlib's savefig takes as *metadata* for files of this ending, as "png"; None if they have none."""
	made = plugin()
	software = f"yade-ddem {made['version']} ({(made['revision'] or 'unknown')[:12]})"
	return {
		"png": {"Software": software, "Description": text()},
		"pdf": {"Creator": software, "Subject": text()},
		"svg": {"Creator": software, "Description": text()},
	}.get(ending.lower().lstrip("."))


def comment(found=None):
	"""The record, or one that is there already, for a comment of XML or HTML, which must not hold two hyphens."""
	line = json.dumps(found or record())
	return f" {KEY}: {line.replace('--', '-' + chr(92) + 'u002d')} "


def read(path):
	"""The record in a file that the package wrote: JSON (of lines: the last), CSV, HTML, PNG, .vtu or .pvd.

	:raises ValueError: it holds none
	"""
	found = _READERS.get(os.path.splitext(path)[1].lower(), lambda path: None)(path)
	if found is None:
		kinds = "JSON, CSV, HTML, PNG, .vtu and .pvd files of this package do"
		raise ValueError(f"{path} does not say where it comes from; {kinds}")
	return found


def _read_json(path):
	with open(path, encoding="utf-8") as file:
		data = json.load(file)
	data = data[0] if isinstance(data, list) and data else data
	return data.get(KEY) if isinstance(data, dict) else None


def _read_jsonl(path):
	with open(path, encoding="utf-8") as file:
		lines = [line for line in file if line.strip()]
	return json.loads(lines[-1]).get(KEY) if lines else None


def _read_lines(pattern):
	"""A reader of text files in which the record follows a pattern."""

	def read_text(path):
		with open(path, encoding="utf-8") as file:
			found = re.search(pattern, file.read(), re.MULTILINE)
		return json.loads(found.group(1)) if found else None

	return read_text


def _read_png(path):
	from PIL import Image
	with Image.open(path) as picture:
		found = picture.text.get("Description")
	return json.loads(found) if found else None


def _read_vtu(path):
	from . import vtk
	found = vtk.field_text(path, KEY)
	return json.loads(found) if found else None


_COMMENT = rf"^\s*<!-- {KEY}: (.*) -->$"
_READERS = {
	".json": _read_json,
	".jsonl": _read_jsonl,
	".csv": _read_lines(rf"^# {KEY}: (.*)$"),
	".html": _read_lines(_COMMENT),
	".pvd": _read_lines(_COMMENT),
	".png": _read_png,
	".vtu": _read_vtu,
}

# ---- what is in it ----


@functools.lru_cache(maxsize=None)
def plugin():
	"""Version, git revision and twelve digits of a hash of the code: libraries and Python modules.

	The revision is that of the checkout when it was installed; the hash tells of changes that were not committed.
	Version and revision are None where they are not known.
	"""
	try:
		from . import _build
		version, revision = _build.VERSION, _build.REVISION
	except ImportError:  # not installed: in a checkout, beside pkg and scripts
		version, revision = version_of(_HERE.parents[1]), revision_of(_HERE.parents[1])
	digest = hashlib.sha256()
	libraries = pathlib.Path(_yade_config().libDir).glob("*ddem*.so") if _yade_config() else ()
	for path in [*sorted(_HERE.rglob("*.py")), *sorted(_HERE.rglob("*.so")), *sorted(libraries)]:
		if path.name != "_build.py":
			digest.update(path.read_bytes())
	return {"version": version, "revision": revision, "code": digest.hexdigest()[:12]}


def version_of(checkout):
	"""The version that a checkout's CMakeLists.txt names; None when there is none."""
	try:
		lines = (pathlib.Path(checkout) / "CMakeLists.txt").read_text(encoding="utf-8")
	except OSError:
		return None
	found = re.search(r"^project\(yade-ddem VERSION ([\d.]+)", lines, re.MULTILINE)
	return found.group(1) if found else None


def revision_of(checkout):
	"""The commit that is checked out, read without git, which may be missing; None when it is no checkout."""
	git = pathlib.Path(checkout) / ".git"
	try:
		if git.is_file():  # a work tree beside the repository
			git = (git.parent / git.read_text().partition("gitdir:")[2].strip()).resolve()
		head = (git / "HEAD").read_text().strip()
		if not head.startswith("ref: "):
			return head
		common = git / (git / "commondir").read_text().strip() if (git / "commondir").is_file() else git
		for folder in (git, common):
			if (folder / head[5:]).is_file():
				return (folder / head[5:]).read_text().strip()
		packed = (common / "packed-refs").read_text().splitlines()
	except OSError:
		return None
	return next((line.split()[0] for line in packed if line.endswith(" " + head[5:])), None)


def machine():
	"""The machine: system, processor, number of its cores."""
	return {"system": platform.platform(), "processor": processor(), "cores": os.cpu_count()}


@functools.lru_cache(maxsize=None)
def processor():
	"""Name of the processor."""
	try:
		with open("/proc/cpuinfo", encoding="utf-8") as file:
			names = (line.split(":", 1)[1].strip() for line in file if line.startswith("model name"))
			return next(names, platform.machine())
	except OSError:
		return platform.machine()


def command():
	"""The command line of this process, without folders outside the current one; None in an interactive session."""
	script = _script()
	if not script:
		return None
	launcher = ["ddem", "run"] if _yade_config() else ["python3"]
	many = _yade_config() and _threads() > 1 and "--threads" not in sys.argv  # an option of some scripts as well
	threads = ["--threads", str(_threads())] if many else []
	return shlex.join([*launcher, *threads, _shown(script[0]), *map(_shown_argument, sys.argv[1:])])


def _shown_argument(argument):
	option, sign, value = argument.rpartition("=")
	return option + sign + (_shown(value) if os.path.isabs(value) else value)


def _script():
	"""The running script, in a list that is empty in an interactive session."""
	path = sys.argv[0] if sys.argv else ""
	return [os.path.abspath(path)] if path.endswith(".py") and os.path.isfile(path) else []


def _shown(path):
	"""A path relative to the current folder, or only its name where it lies outside."""
	relative = os.path.relpath(path)
	return os.path.basename(path) if relative.startswith("..") else relative


def _yade_config():
	"""YADE's configuration; None outside YADE."""
	return sys.modules.get("yade.config")


def _versions():
	import numpy
	config = _yade_config()
	yade = config.version if config else None
	return {"YADE": yade, "Python": platform.python_version(), "numpy": numpy.__version__}


def _threads():
	if not _yade_config():
		return None
	from yade import O
	return O.numThreads


# ---- hashes ----

_OWN_LINE = re.compile(rb"^# provenance: .*\n?", re.MULTILINE)
_known_files = {}  # (path, time, size) -> SHA-256


def _file_sha256(path):
	"""Of a file, without the line that this module adds to CSV files: it changes with every run."""
	status = os.stat(path)
	key = (path, status.st_mtime_ns, status.st_size)
	if key not in _known_files:
		with open(path, "rb") as file:
			_known_files[key] = _sha256(_OWN_LINE.sub(b"", file.read()))
	return _known_files[key]


def _sha256(data):
	return hashlib.sha256(data).hexdigest()


def _text(data):
	return json.dumps(_plain(data), sort_keys=True)


def _plain(value):
	"""Numbers of numpy and sequences as JSON has them, other objects by their names."""
	if hasattr(value, "tolist"):
		return value.tolist()
	if isinstance(value, (set, frozenset)):
		return sorted(value, key=str)
	if isinstance(value, str):
		return os.path.basename(value) if os.path.isfile(value) else value  # its content counts, not its place
	if value is None or isinstance(value, (bool, int, float)):
		return value
	if isinstance(value, dict):
		return {str(name): _plain(one) for name, one in value.items()}
	if isinstance(value, (list, tuple, range)):
		return [_plain(one) for one in value]
	name = getattr(value, "name", None) or getattr(value, "__name__", None)
	return str(name or type(value).__name__)


def _several(values):
	return None if not values else values[0] if len(values) == 1 else list(values)
