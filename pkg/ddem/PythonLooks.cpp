// GPL v2 or later, see LICENSE.
#include <pkg/ddem/PythonLooks.hpp>

#include <lib/pyutil/gil.hpp>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <pthread.h>

namespace yade {

namespace pythonLooks {

CREATE_CPP_LOCAL_LOGGER("PythonLooks.cpp");

namespace {

	enum class Touches { Nothing, OneState };

	// Never destroyed: Python may call to the very end.
	std::vector<LaggingState*>& lagging = *new std::vector<LaggingState*>;
	std::atomic<bool>           anyLags { false }; ///< whether there are any, for calls to ask without a lock
	std::mutex& busy = *new std::mutex;            ///< held while State is shown, and while `lagging` changes

	/// What functions that Python knows touch; others may touch everything. Their objects are kept alive for good.
	std::unordered_map<PyObject*, Touches>& known = *new std::unordered_map<PyObject*, Touches>;

	bool forked = false;

	ternaryfunc   calledByBoost = nullptr;
	PyTypeObject* vectorType    = nullptr; ///< Vector3

	void show(const State* state)
	{
		const std::lock_guard<std::mutex> held(busy);
		for (LaggingState* bodies : lagging)
			bodies->show(state);
	}

	/// Shows the State that a vector is part of: b.state.vel and b.state.angVel are references,
	/// which Python may keep.
	void showOwner(PyObject* argument, bool within = true)
	{
		if (within && (PyList_CheckExact(argument) || PyTuple_CheckExact(argument))) {
			for (Py_ssize_t i = 0; i < PySequence_Fast_GET_SIZE(argument); i++)
				showOwner(PySequence_Fast_GET_ITEM(argument, i), false);
			return;
		}
		if (Py_TYPE(argument) != vectorType) return;
		const boost::python::extract<const Vector3r&> vector(argument);
		if (!vector.check()) return;
		static const State   sample;
		const auto           at = [](const void* part) { return reinterpret_cast<std::uintptr_t>(part); };
		for (const Vector3r* member : { &sample.vel, &sample.angVel })
			show(reinterpret_cast<const State*>(at(&vector()) - (at(member) - at(&sample))));
	}

	void showWhatIsTouched(PyObject* function, PyObject* arguments, PyObject* keywords)
	{
		const auto touches = known.find(function);
		if (touches == known.end()) {
			const std::lock_guard<std::mutex> held(busy);
			for (LaggingState* bodies : lagging)
				bodies->showAll();
			return;
		}
		if (touches->second == Touches::OneState && PyTuple_GET_SIZE(arguments) > 0) {
			const boost::python::extract<const State&> state(PyTuple_GET_ITEM(arguments, 0));
			if (state.check()) show(&state());
		}
		for (Py_ssize_t i = 0; i < PyTuple_GET_SIZE(arguments); i++)
			showOwner(PyTuple_GET_ITEM(arguments, i));
		PyObject * name = nullptr, *value = nullptr;
		for (Py_ssize_t place = 0; keywords && PyDict_Next(keywords, &place, &name, &value);)
			showOwner(value);
	}

	PyObject* callWatched(PyObject* function, PyObject* arguments, PyObject* keywords)
	{
		if (anyLags.load(std::memory_order_acquire)) showWhatIsTouched(function, arguments, keywords);
		return calledByBoost(function, arguments, keywords);
	}

	/// All functions of Boost.Python share one type, and every way to call them goes through its slot.
	void watch()
	{
		namespace py           = boost::python;
		const py::object looks = py::import("yade.ddem.looks");
		const auto       list  = [&looks](const char* name, Touches touches) {
                        const py::object functions = looks.attr(name)();
                        for (py::ssize_t i = 0; i < py::len(functions); i++) {
                                const py::object function = functions[i];
                                if (known.emplace(function.ptr(), touches).second) Py_INCREF(function.ptr());
                        }
		};
		list("touching_one_state", Touches::OneState);
		list("touching_nothing", Touches::Nothing);
		const py::object vector = looks.attr("minieigenHP").attr("Vector3");
		vectorType              = reinterpret_cast<PyTypeObject*>(vector.ptr());
		if (known.empty()) throw std::runtime_error("yade.ddem.looks lists no functions");
		PyTypeObject* const type = Py_TYPE(known.begin()->first);
		calledByBoost            = type->tp_call;
		type->tp_call            = callWatched;
		// f.__call__(…), too
		PyObject* const method = PyDict_GetItemString(type->tp_dict, "__call__");
		if (method && Py_TYPE(method) == &PyWrapperDescr_Type)
			reinterpret_cast<PyWrapperDescrObject*>(method)->d_wrapped
			        = reinterpret_cast<void*>(callWatched);
		PyType_Modified(type);
		// os.fork() and multiprocessing in a command
		pthread_atfork(
		        [] { busy.lock(); }, [] { busy.unlock(); },
		        [] {
			        busy.unlock();
			        forked = true;
		        });
	}

} // namespace

bool watched()
{
	static const bool success = [] {
		const gilLock lock;
		try {
			watch();
			return true;
		} catch (const boost::python::error_already_set&) {
			PyErr_Print();
		} catch (const std::exception& e) {
			LOG_WARN(e.what());
		}
		LOG_WARN("State is written back to all bodies before every Python command, which is slow: see above");
		return false;
	}();
	return success;
}

std::unique_lock<std::mutex> lock() { return std::unique_lock<std::mutex>(busy); }

bool inForkedProcess() { return forked; }

void begin(LaggingState& bodies)
{
	const std::lock_guard<std::mutex> held(busy);
	if (std::find(lagging.begin(), lagging.end(), &bodies) == lagging.end()) lagging.push_back(&bodies);
	anyLags = true;
}

void end(LaggingState& bodies)
{
	if (!anyLags) return;
	const std::lock_guard<std::mutex> held(busy);
	lagging.erase(std::remove(lagging.begin(), lagging.end(), &bodies), lagging.end());
	anyLags = !lagging.empty();
}

} // namespace pythonLooks

} // namespace yade
