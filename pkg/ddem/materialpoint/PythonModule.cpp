// GPL v2 or later, see LICENSE.
// The Python extension yade.ddem._materialpoint: the material-point driver. Users call yade.ddem.materialpoint, which adds names and checks.

#include <boost/python.hpp>
#include <boost/python/numpy.hpp>

#include <pkg/ddem/kernel/laws/MaterialPoint.hpp>

#include <memory>
#include <stdexcept>
#include <utility>

namespace py = boost::python;
namespace np = boost::python::numpy;

namespace yade::ddem {

namespace {
	struct ParameterName {
		const char* name;
		double ConcreteParameters::* value;
	};

	constexpr ParameterName parameterNames[] = {
		{ "bulk", &ConcreteParameters::bulk },
		{ "shear", &ConcreteParameters::shear },
		{ "rotationStiffness", &ConcreteParameters::rotationStiffness },
		{ "density", &ConcreteParameters::density },
		{ "eosPressure", &ConcreteParameters::eosPressure },
		{ "eosExponent", &ConcreteParameters::eosExponent },
		{ "strength", &ConcreteParameters::strength },
		{ "flowFactor", &ConcreteParameters::flowFactor },
		{ "flowExponent", &ConcreteParameters::flowExponent },
		{ "rateExponent", &ConcreteParameters::rateExponent },
		{ "frictionPressure", &ConcreteParameters::frictionPressure },
		{ "frictionPressureExponent", &ConcreteParameters::frictionPressureExponent },
		{ "friction", &ConcreteParameters::friction },
		{ "closedGrowth", &ConcreteParameters::closedGrowth },
		{ "closedEffect", &ConcreteParameters::closedEffect },
		{ "fractureEnergy", &ConcreteParameters::fractureEnergy },
		{ "damageExponent", &ConcreteParameters::damageExponent },
		{ "damageLimit", &ConcreteParameters::damageLimit },
		{ "referenceRate", &ConcreteParameters::referenceRate },
		{ "sharingTolerance", &ConcreteParameters::sharingTolerance },
		{ "closureBand", &ConcreteParameters::closureBand },
		{ "residual", &ConcreteParameters::residual },
	};
	// a parameter that is added to the struct must be added here
	static_assert(sizeof(ConcreteParameters) == sizeof(parameterNames) / sizeof(ParameterName) * sizeof(double), "every parameter needs its name");

	py::dict defaults()
	{
		const ConcreteParameters parameters;
		py::dict                 result;
		for (const ParameterName& p : parameterNames)
			result[p.name] = parameters.*p.value;
		return result;
	}

	/// Parameters from a dict that has all the names of defaults().
	ConcreteParameters parametersOf(const py::dict& values)
	{
		ConcreteParameters parameters;
		for (const ParameterName& p : parameterNames)
			parameters.*p.value = py::extract<double>(values[p.name]);
		return parameters;
	}

	void validate(const py::dict& values) { parametersOf(values).validate(); }

	PlaneTensor tensorOf(const py::object& four)
	{
		if (py::len(four) != 4) throw std::invalid_argument("a tensor has the four components xx, yy, zz, xy");
		const auto component = [&](int i) {
			const double value = PyFloat_AsDouble(py::object(four[i]).ptr());
			if (PyErr_Occurred()) py::throw_error_already_set();
			return value;
		};
		return { component(0), component(1), component(2), component(3) };
	}

	// Columns of a row of results; the Python face names the slices.
	constexpr int columns = 22;

	void writeRow(const PreparedConcrete& concrete, const PathPoint& point, double* to)
	{
		const ConcreteState& s = point.state;
		*to++                  = point.time;
		for (const PlaneTensor* tensor : { &s.strain, &s.stress, &s.plasticStrain, &s.damage })
			for (const double component : { tensor->xx, tensor->yy, tensor->zz, tensor->xy })
				*to++ = component;
		*to++ = damageRatio(concrete, s);
		*to++ = 1 + s.stiffening;
		*to++ = s.plasticDissipation;
		*to++ = s.damageDissipation;
		*to++ = storedEnergy(s);
	}

	np::ndarray rowsOf(const PreparedConcrete& concrete, const std::vector<PathPoint>& points)
	{
		np::ndarray rows = np::empty(py::make_tuple(points.size(), columns), np::dtype::get_builtin<double>());
		double*     to   = reinterpret_cast<double*>(rows.get_data());
		for (const PathPoint& point : points)
			writeRow(concrete, point, std::exchange(to, to + columns));
		return rows;
	}

	std::shared_ptr<MaterialPoint> makePoint(const py::dict& parameters, unsigned effects, const py::object& damage, double bandFactor)
	{
		return std::make_shared<MaterialPoint>(parametersOf(parameters), effects, tensorOf(damage), bandFactor);
	}

	np::ndarray
	run(MaterialPoint& point, const std::string& stressControlled, const py::object& target, double duration, std::size_t steps, std::size_t every)
	{
		PathLeg leg { { Control::Strain, Control::Strain, Control::Strain, Control::Strain }, tensorOf(target), duration, steps };
		for (std::size_t k = 0; k < 4; ++k)
			if (stressControlled.at(k) == 's') leg.control[k] = Control::Stress;
		return rowsOf(point.concrete(), point.run(leg, every));
	}

	np::ndarray row(const MaterialPoint& point) { return rowsOf(point.concrete(), { { point.time(), point.state() } }); }
}

} // namespace yade::ddem

BOOST_PYTHON_MODULE(_materialpoint)
{
	using namespace yade::ddem;
	np::initialize();
	py::def("defaults", defaults, "Parameters of concrete, Zubelewicz (2018), Tables 1 and 2, by name.");
	py::def("validate", validate, "ValueError for a parameter that is not allowed.");
	py::class_<MaterialPoint, std::shared_ptr<MaterialPoint>, boost::noncopyable>("Point", py::no_init)
	        .def("__init__", py::make_constructor(makePoint, py::default_call_policies(), (py::arg("parameters"), py::arg("effects"), py::arg("damage"), py::arg("bandFactor"))))
	        .def("run",
	             run,
	             (py::arg("control"), py::arg("target"), py::arg("duration"), py::arg("steps"), py::arg("every")),
	             "Runs a leg; control has a letter for xx, yy, zz, xy: 's' stress, 'e' strain. Returns a row per recorded step.")
	        .def("row", row, "The present state as one row.");
	py::scope scope;
	py::dict  effects;
	effects["viscoplasticFlow"] = unsigned(ConcreteEffects::Flow);
	effects["rateDependence"]   = unsigned(ConcreteEffects::Rate);
	effects["damage"]           = unsigned(ConcreteEffects::Damage);
	effects["equationOfState"]  = unsigned(ConcreteEffects::EquationOfState);
	scope.attr("effects")       = effects;
	scope.attr("energy")        = unsigned(ConcreteEffects::Energy);
}
