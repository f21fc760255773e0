// GPL v2 or later, see LICENSE
// The Python extension yade.ddem._mesh: arrays in and out of the mesh generator. Users call yade.ddem.mesh,
// which checks its arguments first.

#include <boost/python.hpp>

#include <pkg/ddem/mesh/Mesher.hpp>
#include <pkg/ddem/mesh/PlaneSearch.hpp>

#include <cstring>
#include <stdexcept>

namespace py = boost::python;

namespace yade::ddem::mesh {

namespace {
	// Copy of a C-contiguous array (anything with the buffer protocol) as records of a plain type.
	template <class Record> std::vector<Record> records(const py::object& array, const char* name)
	{
		Py_buffer view;
		if (PyObject_GetBuffer(array.ptr(), &view, PyBUF_C_CONTIGUOUS) != 0) py::throw_error_already_set();
		const auto bytes = std::size_t(view.len);
		if (bytes % sizeof(Record) != 0) {
			PyBuffer_Release(&view);
			throw std::invalid_argument(std::string(name) + ": wrong number type or shape");
		}
		std::vector<Record> result(bytes / sizeof(Record));
		if (bytes > 0) std::memcpy(result.data(), view.buf, bytes);
		PyBuffer_Release(&view);
		return result;
	}

	template <class Record> py::object toBytes(const std::vector<Record>& values)
	{
		return py::object(py::handle<>(PyBytes_FromStringAndSize(
		        reinterpret_cast<const char*>(values.data()), Py_ssize_t(values.size() * sizeof(Record)))));
	}

	void checkIndices(const std::vector<int>& indices, std::size_t count)
	{
		for (const int index : indices)
			if (index < 0 || std::size_t(index) >= count)
				throw std::invalid_argument("point index " + std::to_string(index) + " out of range");
	}

	py::tuple pyTriangulate(
	        const py::object& points,
	        const py::object& segments,
	        const py::list&   holes,
	        const py::object& size,
	        double            longestEdgeFactor,
	        double            smallestAngle,
	        int               smoothing,
	        long              limit)
	{
		Domain domain { records<Point>(points, "points"),
			        records<std::array<int, 2>>(segments, "segments"),
			        {} };
		checkIndices(records<int>(segments, "segments"), domain.points.size());
		for (py::ssize_t i = 0; i < py::len(holes); ++i) {
			domain.holes.push_back(records<int>(holes[i], "hole"));
			checkIndices(domain.holes.back(), domain.points.size());
		}
		Criteria criteria { longestEdgeFactor, smallestAngle, {}, smoothing, std::size_t(limit), {} };

		criteria.tick = [] {
			if (PyErr_CheckSignals() != 0) py::throw_error_already_set(); // Ctrl-C
		};
		if (PyCallable_Check(size.ptr()))
			criteria.size = [&size](double x, double y) { return double(py::extract<double>(size(x, y))); };
		else
			criteria.size = [value = double(py::extract<double>(size))](double, double) { return value; };
		const Triangulation result = triangulate(domain, criteria);
		return py::make_tuple(toBytes(result.nodes), toBytes(result.triangles));
	}

	py::object pyHilbertOrder(const py::object& points)
	{
		return toBytes(hilbertOrder(records<Point>(points, "points")));
	}

	py::object pyFirstCrossing(const py::object& points, const py::object& segments)
	{
		const auto located = records<Point>(points, "points");
		checkIndices(records<int>(segments, "segments"), located.size());
		const auto crossing = firstCrossing(located, records<std::array<int, 2>>(segments, "segments"));
		if (!crossing) return py::object();
		return py::make_tuple(crossing->first, crossing->second, crossing->at.x, crossing->at.y);
	}

	py::object pyFirstConflict(const py::object& points, const py::object& triangles, double relativeGap)
	{
		const auto located = records<Point>(points, "points");
		checkIndices(records<int>(triangles, "triangles"), located.size());
		const auto conflict
		        = firstConflict(located, records<std::array<int, 3>>(triangles, "triangles"), relativeGap);
		if (!conflict) return py::object();
		return py::make_tuple(conflict->first, conflict->second, conflict->node);
	}
}

} // namespace yade::ddem::mesh

BOOST_PYTHON_MODULE(_mesh)
{
	using namespace yade::ddem::mesh;
	py::scope().attr("__doc__") = "CGAL mesh generation behind yade.ddem.mesh; points are float64 (n,2) [m], "
	                              "indices int32. Arrays come back as bytes.";
	py::def("triangulate", &pyTriangulate,
	        (py::arg("points"), "segments", "holes", "size", "longestEdgeFactor", "smallestAngle", "smoothing",
	         "limit"),
	        "Nodes (float64) and triangles (int32) of the domain; size is a length [m] or a function of x, y [m]; "
	        "angle in radian.");
	py::def("hilbertOrder", &pyHilbertOrder, py::arg("points"),
	        "Indices (int32) of the points along a Hilbert curve.");
	py::def("firstCrossing", &pyFirstCrossing, (py::arg("points"), "segments"),
	        "(segment, segment, x, y) of two segments in conflict, or None.");
	py::def("firstConflict",
	        &pyFirstConflict,
	        (py::arg("points"), "triangles", "relativeGap"),
	        "(triangle, triangle, node) that overlap (node -1), or of the first's node hanging on an edge of the "
	        "second; or None.");
	py::def("guaranteedAngle", &guaranteedAngle,
	        "Largest smallest angle [rad] that the mesh generator guarantees.");
}
