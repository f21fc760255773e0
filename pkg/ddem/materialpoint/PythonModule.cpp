// GPL v2 or later, see LICENSE.
// The Python extension yade.ddem._materialpoint: the material-point driver of every law. Users call
// yade.ddem.materialpoint, which adds names and checks.

#include <boost/python.hpp>
#include <boost/python/numpy.hpp>

#include <laws/AllLaws.hpp>
#include <pkg/ddem/kernel/triangles/PointOf.hpp>

#include <memory>
#include <stdexcept>

namespace py = boost::python;
namespace np = boost::python::numpy;

namespace yade::ddem {

namespace {

	PlaneTensor tensorFrom(const py::object& four)
	{
		if (py::len(four) != 4) throw std::invalid_argument("a tensor has the four components xx, yy, zz, xy");
		const auto component = [&](int i) {
			const double value = PyFloat_AsDouble(py::object(four[i]).ptr());
			if (PyErr_Occurred()) py::throw_error_already_set();
			return value;
		};
		return { component(0), component(1), component(2), component(3) };
	}

	/// Appends the numbers of a state's fields to a row.
	struct WriteFields {
		std::vector<double>& row;

		void scalar(const char*, const char*, double& from) { row.push_back(from); }
		void inPlane(const char*, const char*, PlaneTensor& from)
		{
			row.insert(row.end(), { from.xx, from.yy, from.xy });
		}
		void tensor(const char*, const char*, PlaneTensor& from)
		{
			row.insert(row.end(), { from.xx, from.yy, from.zz, from.xy });
		}
	};

	/// A point of any law. A row of results: time, strain, stress, stored, plastic and damage energy, damage,
	/// factor on the moduli, fields.
	class Point {
	public:
		virtual ~Point() = default;

		virtual np::ndarray
		run(const std::string& control, const py::object& target, double duration, std::size_t steps,
		    std::size_t every)
		        = 0;
		virtual np::ndarray row() const    = 0;
		virtual py::list    fields() const = 0;
	};

	template <class Law> class PointFor : public Point {
	public:
		PointFor(
		        const typename Law::Parameters& parameters, unsigned effects,
		        const TriangleProperties& properties)
		        : point(parameters, effects, properties)
		{
		}
		np::ndarray
		run(const std::string& control, const py::object& target, double duration, std::size_t steps,
		    std::size_t every) override
		{
			PathLeg leg { { Control::Strain, Control::Strain, Control::Strain, Control::Strain },
				      tensorFrom(target),
				      duration,
				      steps };
			for (std::size_t k = 0; k < 4; ++k)
				if (control.at(k) == 's') leg.control[k] = Control::Stress;
			return rows(point.run(leg, every));
		}
		np::ndarray row() const override { return rows({ point.point() }); }
		py::list    fields() const override
		{
			ListFields list;
			withMask<Law>(point.effects(), [&](auto mask) {
				typename Law::template State<double> s {};
				Law::template fields<mask()>(s, list);
			});
			py::list result;
			for (const StateField& f : list.list)
				result.append(py::make_tuple(f.name, f.unit, f.components()));
			return result;
		}

	private:
		PointOf<Law> point;

		np::ndarray rows(const std::vector<typename PointOf<Law>::PathPoint>& points) const
		{
			std::vector<double> numbers;
			for (auto p : points) {
				numbers.push_back(p.time);
				for (const PlaneTensor* t : { &p.strain, &p.stress })
					numbers.insert(numbers.end(), { t->xx, t->yy, t->zz, t->xy });
				const auto& law = point.prepared();
				numbers.insert(
				        numbers.end(), { p.energies.stored, p.energies.plastic, p.energies.damage });
				numbers.push_back(
				        Law::damages(point.effects()) ? Law::damage(law, point.properties(), p.state)
				                                      : 0);
				numbers.push_back(Law::stiffens(point.effects()) ? Law::stiffening(law, p.state) : 1);
				withMask<Law>(point.effects(), [&](auto mask) {
					Law::template fields<mask()>(p.state, WriteFields { numbers });
				});
			}
			const std::size_t columns = points.empty() ? 0 : numbers.size() / points.size();
			np::ndarray       result
			        = np::empty(py::make_tuple(points.size(), columns), np::dtype::get_builtin<double>());
			std::copy(numbers.begin(), numbers.end(), reinterpret_cast<double*>(result.get_data()));
			return result;
		}
	};

	/// What is known of a law by its name.
	struct LawEntry {
		std::string                     name;
		std::vector<ParameterEntry>     parameters;
		std::vector<LawEffect>          effects;
		void                            (*validate)(const py::dict&);
		std::shared_ptr<Point>          (*make)(const py::dict&, unsigned, const TriangleProperties&);
	};

	/// Parameters from a dict that has all the names.
	template <class Law> typename Law::Parameters parametersOf(const py::dict& values)
	{
		typename Law::Parameters parameters;
		for (const ParameterEntry& p : Law::Parameters::entries())
			p.set(&parameters, py::extract<double>(values[p.name]));
		return parameters;
	}

	template <class... Laws> struct Table {
		static const std::vector<LawEntry>& all()
		{
			static const std::vector<LawEntry> entries { entry<Laws>()... };
			return entries;
		}
		template <class Law> static LawEntry entry()
		{
			return { Law::name,
				 Law::Parameters::entries(),
				 Law::effects(),
				 [](const py::dict& values) {
				         typename Law::Prepared prepared(parametersOf<Law>(values));
				         (void)prepared;
				 },
				 [](const py::dict&           values,
				    unsigned                  effects,
				    const TriangleProperties& properties) -> std::shared_ptr<Point> {
				         return std::make_shared<PointFor<Law>>(
				                 parametersOf<Law>(values), effects, properties);
				 } };
		}
	};

	const LawEntry& lawNamed(const std::string& name)
	{
		std::string names;
		for (const LawEntry& entry : AllLaws<Table>::all()) {
			if (entry.name == name) return entry;
			names += (names.empty() ? "" : ", ") + entry.name;
		}
		throw std::invalid_argument("law '" + name + "' is unknown; there are " + names);
	}

	py::list laws()
	{
		py::list names;
		for (const LawEntry& entry : AllLaws<Table>::all())
			names.append(entry.name);
		return names;
	}

	py::list parameters(const std::string& law)
	{
		py::list list;
		for (const ParameterEntry& p : lawNamed(law).parameters)
			list.append(py::make_tuple(p.name, p.standard, p.unit, p.bounds.words(), p.doc));
		return list;
	}

	py::dict effects(const std::string& law)
	{
		py::dict bits;
		for (const LawEffect& effect : lawNamed(law).effects)
			bits[effect.name] = effect.bit;
		return bits;
	}

	void validate(const std::string& law, const py::dict& values) { lawNamed(law).validate(values); }

	std::shared_ptr<Point> makePoint(
	        const std::string& law, const py::dict& values, unsigned mask, const py::object& damage,
	        double bandFactor, double area)
	{
		return lawNamed(law).make(values, mask, { area, -1, bandFactor, tensorFrom(damage) });
	}
}

} // namespace yade::ddem

BOOST_PYTHON_MODULE(_materialpoint)
{
	using namespace yade::ddem;
	np::initialize();
	py::def("laws", laws, "Names of all laws.");
	py::def("parameters", parameters, py::arg("law"),
	        "Parameters of a law: (name, default, unit, bounds in words, meaning).");
	py::def("effects", effects, py::arg("law"), "Bits of a law's effects by name.");
	py::def("validate", validate, (py::arg("law"), py::arg("values")),
	        "ValueError for a parameter that is not allowed.");
	py::class_<Point, std::shared_ptr<Point>, boost::noncopyable>("Point", py::no_init)
	        .def("__init__",
	             py::make_constructor(
	                     makePoint, py::default_call_policies(),
	                     (py::arg("law"), py::arg("parameters"), py::arg("effects"), py::arg("damage"),
	                      py::arg("bandFactor"), py::arg("area"))))
	        .def("run", &Point::run,
	             (py::arg("control"), py::arg("target"), py::arg("duration"), py::arg("steps"), py::arg("every")),
	             "Runs a leg; control has a letter for xx, yy, zz, xy: 's' stress, 'e' strain. Returns a row per "
	             "recorded step.")
	        .def("row", &Point::row, "The present state as one row.")
	        .def("fields", &Point::fields, "Fields at the end of a row: (name, unit, components).");
	py::scope().attr("energy") = unsigned(LawEffects::Energy);
}
