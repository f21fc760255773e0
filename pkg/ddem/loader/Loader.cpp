// GPL v2 or later, see LICENSE.
// The library YADE opens at start: checks that the plugin fits the running YADE,
// and only then opens the plugin's classes.
//
// YADE opens every lib*.so in its directory and aborts when one of them cannot be opened or throws.  This one always
// opens.  When the plugin does not fit, it says why, YADE goes on without it, and "from yade import ddem" is an
// ImportError with the same words.
#include <boost/python.hpp>
#include <pkg/ddem/loader/LayoutCheck.hpp>
#include <cstdio>
#include <dlfcn.h>
#include <stdexcept>
#include <string>

namespace {

namespace py = boost::python;

/// The directory this very library was opened from.
std::string ownDirectory()
{
	Dl_info info;
	if (!dladdr(reinterpret_cast<void*>(&ownDirectory), &info))
		throw std::runtime_error("cannot find its own file");
	const std::string file(info.dli_fname);
	return file.substr(0, file.rfind('/'));
}

/// Version and features of the running YADE against those the plugin was built for; empty when equal.
std::string buildDifferences()
{
	const py::object config   = py::import("yade.config");
	const auto       version  = py::extract<std::string>(config.attr("version"))();
	const auto       features = py::extract<std::string>(py::str(" ").join(config.attr("features")))();
	std::string      text;
	if (version != DDEM_YADE_VERSION)
		text += "  version: YADE is " + version + ", the plugin was built for " DDEM_YADE_VERSION "\n";
	if (features != DDEM_YADE_FEATURES)
		text += "  features: YADE has " + features
		        + ",\n            the plugin was built for " DDEM_YADE_FEATURES "\n";
	return text;
}

void openClasses(const std::string& directory)
{
	const std::string file = directory + "/ddem_classes.so";
	if (!dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL))
		throw std::runtime_error(std::string("  ") + dlerror() + "\n");
	// The yade package may lie in another prefix than this library (YADE_PREFIX): ours is found beside it.
	py::object path = py::import("yade").attr("__path__");
	const py::str mine(directory + "/py/yade");
	if (!py::extract<bool>(path.attr("__contains__")(mine))()) path.attr("append")(mine);
}

void refuse(const std::string& differences)
{
	const std::string text = "The plugin yade-ddem does not fit this YADE and stays out of it:\n" + differences
	        + "Build it again for this YADE: 'scripts/ddem setup', or cmake with a fresh build directory and "
	          "-DYADE_SOURCE_DIR= of this version.";
	std::fprintf(stderr, "%s\n", text.c_str());
	py::dict names;
	names["text"] = text;
	py::exec(R"(
import sys
class Refusal:
	def find_spec(self, name, path=None, target=None):
		if name == 'yade.ddem': raise ImportError(text, name=name)
sys.meta_path.insert(0, Refusal())
)", names, names);
}

__attribute__((constructor)) void load()
{
	const PyGILState_STATE lock = PyGILState_Ensure();
	try {
		std::string differences = buildDifferences();
		if (differences.empty()) differences = yade::ddem::layoutDifferences();
		if (differences.empty()) openClasses(ownDirectory());
		else
			refuse(differences);
	} catch (const py::error_already_set&) {
		PyErr_Print();
		refuse("  (the Python error above)\n");
	} catch (const std::exception& error) {
		refuse(error.what());
	}
	PyGILState_Release(lock);
}

} // namespace
