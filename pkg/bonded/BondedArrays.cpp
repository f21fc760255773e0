// GPL v2 or later, see LICENSE.
#include <pkg/bonded/BondedArrays.hpp>
#include <pkg/bonded/BondedPhys.hpp>
#include <pkg/bonded/BondedSpheres.hpp>
#include <pkg/bonded/BrokenBond.hpp>

#include <boost/python/numpy.hpp>

#include <algorithm>
#include <tuple>

namespace yade {

namespace {

	namespace numpy = boost::python::numpy;

	/// A new array of rows of `columns` numbers, a flat one where there is one, filled by fill(row, to).
	template <class Number, class Fill>
	numpy::ndarray table(std::size_t rows, std::size_t columns, const Fill& fill)
	{
		static const bool started = (numpy::initialize(), true);
		(void)started;
		const auto           shape = columns == 1 ? boost::python::make_tuple(rows)
		                                          : boost::python::make_tuple(rows, columns);
		const numpy::ndarray result = numpy::empty(shape, numpy::dtype::get_builtin<Number>());
		auto* const          to     = reinterpret_cast<Number*>(result.get_data());
		for (std::size_t i = 0; i < rows; i++)
			fill(i, to + i * columns);
		return result;
	}

	void put(const Vector3r& v, Real* to) { std::copy_n(v.data(), 3, to); }

	using Quantity = void (*)(const State&, Real*);

	Quantity quantity(const std::string& name)
	{
		if (name == "position") return [](const State& s, Real* to) { put(s.pos, to); };
		if (name == "displacement") return [](const State& s, Real* to) { put(s.displ(), to); };
		if (name == "velocity") return [](const State& s, Real* to) { put(s.vel, to); };
		if (name == "spin") return [](const State& s, Real* to) { put(s.angVel, to); };
		if (name == "rotation") return [](const State& s, Real* to) { put(s.rot(), to); };
		throw std::invalid_argument(
		        "sphereArray: '" + name + "' is unknown; there are position, displacement, velocity, spin, "
		        "rotation, radius");
	}

	const Body& sphereOf(const Scene& scene, Body::id_t id)
	{
		if (!scene.bodies->exists(id) || !isSphere(*(*scene.bodies)[id]))
			throw std::invalid_argument("sphereArray: body #" + std::to_string(id) + " is no sphere");
		return *(*scene.bodies)[id];
	}

} // namespace

std::vector<Body::id_t> bodyIdsOf(const boost::python::object& ids)
{
	Py_buffer  view;
	PyObject*  given = ids.ptr();
	std::vector<Body::id_t> result;
	if (PyObject_CheckBuffer(given) && PyObject_GetBuffer(given, &view, PyBUF_FORMAT | PyBUF_C_CONTIGUOUS) == 0) {
		const std::string format = view.format ? view.format : "B";
		if (format == "l" && view.itemsize == sizeof(long)) {
			const auto* from = static_cast<const long*>(view.buf);
			result.assign(from, from + view.len / view.itemsize);
			PyBuffer_Release(&view);
			return result;
		}
		PyBuffer_Release(&view);
	}
	PyErr_Clear();
	boost::python::stl_input_iterator<long> begin(ids), end;
	for (; begin != end; ++begin)
		result.push_back(Body::id_t(*begin));
	return result;
}

boost::python::object existingBodies(const Scene& scene, const boost::python::object& ids)
{
	std::vector<Body::id_t> there = bodyIdsOf(ids);
	there.erase(
	        std::remove_if(there.begin(), there.end(), [&](Body::id_t id) { return !scene.bodies->exists(id); }),
	        there.end());
	return table<long>(there.size(), 1, [&](std::size_t i, long* to) { *to = there[i]; });
}

boost::python::object
sphereArray(const Scene& scene, const BondedSpheres* spheres, const boost::python::object& ids, const std::string& name)
{
	const std::vector<Body::id_t> wanted = bodyIdsOf(ids);
	if (name == "radius")
		return table<Real>(wanted.size(), 1, [&](std::size_t i, Real* to) {
			*to = static_cast<const Sphere&>(*sphereOf(scene, wanted[i]).shape).radius;
		});
	const Quantity of = quantity(name);
	State          now; // State itself may lag
	return table<Real>(wanted.size(), 3, [&](std::size_t i, Real* to) {
		const State& state = *sphereOf(scene, wanted[i]).state;
		if (!spheres || !spheres->isAhead(wanted[i])) return of(state, to);
		spheres->copyTo(now, wanted[i]);
		now.refPos = state.refPos;
		now.refOri = state.refOri;
		of(now, to);
	});
}

boost::python::dict bondArrays(std::vector<BondNow> bonds)
{
	const auto order = [](const BondNow& a, const BondNow& b) {
		return std::tie(a.id1, a.id2) < std::tie(b.id1, b.id2);
	};
	for (BondNow& bond : bonds)
		if (bond.id1 > bond.id2) std::swap(bond.id1, bond.id2);
	if (!std::is_sorted(bonds.begin(), bonds.end(), order)) std::sort(bonds.begin(), bonds.end(), order);
	boost::python::dict result;
	result["ids"] = table<long>(bonds.size(), 2, [&](std::size_t i, long* to) {
		to[0] = bonds[i].id1;
		to[1] = bonds[i].id2;
	});
	const auto column = [&](const char* name, Real BondNow::*member) {
		result[name] = table<Real>(bonds.size(), 1, [&](std::size_t i, Real* to) { *to = bonds[i].*member; });
	};
	column("normalStress", &BondNow::normalStress);
	column("shearStress", &BondNow::shearStress);
	column("radius", &BondNow::radius);
	column("axialForce", &BondNow::axialForce);
	column("shearForce", &BondNow::shearForce);
	return result;
}

boost::python::dict brokenArrays(const std::vector<shared_ptr<BrokenBond>>& records)
{
	boost::python::dict result;
	const auto whole = [&](const char* name, auto value) {
		result[name]
		        = table<long>(records.size(), 1, [&](std::size_t i, long* to) { *to = value(*records[i]); });
	};
	const auto real = [&](const char* name, Real BrokenBond::*member) {
		result[name]
		        = table<Real>(records.size(), 1, [&](std::size_t i, Real* to) { *to = (*records[i]).*member; });
	};
	const auto vector = [&](const char* name, Vector3r BrokenBond::*member) {
		result[name] = table<Real>(
		        records.size(), 3, [&](std::size_t i, Real* to) { put((*records[i]).*member, to); });
	};
	whole("id1", [](const BrokenBond& b) { return long(b.id1); });
	whole("id2", [](const BrokenBond& b) { return long(b.id2); });
	whole("step", [](const BrokenBond& b) { return b.iter; });
	whole("mode", [](const BrokenBond& b) { return long(b.mode); });
	real("time", &BrokenBond::time);
	real("radius", &BrokenBond::radius);
	real("normal_stress", &BrokenBond::normalStress);
	real("shear_stress", &BrokenBond::shearStress);
	real("energy", &BrokenBond::energy);
	vector("position", &BrokenBond::pos);
	vector("normal", &BrokenBond::normal);
	return result;
}

} // namespace yade
