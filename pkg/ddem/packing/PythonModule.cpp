// GPL v2 or later, see LICENSE.
// The Python extension yade.ddem._packing: a convex specimen in, spheres out. Users call yade.ddem.packing.fill, which
// checks its arguments first.

#include <boost/python.hpp>
#include <boost/python/numpy.hpp>

#include <pkg/bonded/kernel/packing/InsertionPacking.hpp>

#include <string>

namespace py = boost::python;
namespace np = boost::python::numpy;

namespace yade::ddem {

namespace {
	SpaceVector<double> vectorFrom(const py::object& three)
	{
		return { py::extract<double>(three[0]), py::extract<double>(three[1]), py::extract<double>(three[2]) };
	}

	SpecimenWall wallFrom(const py::object& wall)
	{
		const std::string kind = py::extract<std::string>(wall[0]);
		const double      size = py::extract<double>(wall[2]);
		if (kind == "plane") return { WallKind::Plane, vectorFrom(wall[1]), size };
		if (kind == "ball") return { WallKind::Ball, vectorFrom(wall[1]), size };
		if (kind == "cylinder") return { WallKind::Cylinder, vectorFrom(wall[1]), size, vectorFrom(wall[3]) };
		throw std::invalid_argument("wall '" + kind + "' is unknown; there are plane, ball and cylinder");
	}

	np::ndarray
	fill(int               dimension,
	     const py::object& lower,
	     const py::object& upper,
	     const py::list&   walls,
	     double            smallest,
	     double            largest,
	     std::uint64_t     seed,
	     std::uint64_t     fails)
	{
		Specimen specimen { dimension, vectorFrom(lower), vectorFrom(upper), {} };
		for (py::ssize_t i = 0; i < py::len(walls); ++i)
			specimen.walls.push_back(wallFrom(walls[i]));
		const auto interrupt = [] {
			if (PyErr_CheckSignals() != 0) py::throw_error_already_set(); // Ctrl-C
		};
		const auto  spheres = fillSpecimen(specimen, { smallest, largest, seed, fails, interrupt }).spheres;
		np::ndarray rows    = np::empty(py::make_tuple(spheres.size(), 4), np::dtype::get_builtin<double>());
		double*     next    = reinterpret_cast<double*>(rows.get_data());
		for (const PackedSphere& sphere : spheres)
			for (const double value : { sphere.centre.x, sphere.centre.y, sphere.centre.z, sphere.radius })
				*next++ = value;
		return rows;
	}
}

} // namespace yade::ddem

BOOST_PYTHON_MODULE(_packing)
{
	np::initialize();
	py::def("fill", yade::ddem::fill,
	        (py::arg("dimension"), "lower", "upper", "walls", "smallest", "largest", "seed", "fails"),
	        "Rows x, y, z, r [m] of a packing. Walls: ('plane', inward normal, offset), ('ball', centre, radius), "
	        "('cylinder', point on the axis, radius, axis).");
}
