// GPL v2 or later, see LICENSE.
#include <pkg/ddem/SampleArrays.hpp>

#include <boost/python/numpy.hpp>

namespace yade {

namespace {

	namespace np = boost::python::numpy;

	void startNumpy()
	{
		static const bool started = (np::initialize(), true);
		(void)started;
	}

	boost::python::tuple shapeOf(const std::vector<std::size_t>& sizes)
	{
		boost::python::list list;
		for (const auto size : sizes)
			list.append(size);
		return boost::python::tuple(list);
	}

	/// A view of an array of the system that keeps the system alive.
	np::ndarray
	view(const shared_ptr<ddem::TriangleSystem>& system, ddem::ReservedArray<double>& data, std::size_t columns)
	{
		using Owner      = shared_ptr<ddem::TriangleSystem>;
		PyObject* handle = PyCapsule_New(new Owner(system), nullptr, [](PyObject* capsule) {
			delete static_cast<Owner*>(PyCapsule_GetPointer(capsule, nullptr));
		});
		const boost::python::object   owner { boost::python::handle<>(handle) };
		const std::size_t             rows = data.size() / columns;
		const std::vector<std::size_t> sizes
		        = columns == 1 ? std::vector<std::size_t> { rows } : std::vector<std::size_t> { rows, columns };
		const boost::python::tuple strides = columns == 1
		        ? boost::python::make_tuple(sizeof(double))
		        : boost::python::make_tuple(columns * sizeof(double), sizeof(double));
		return np::from_data(data.data(), np::dtype::get_builtin<double>(), shapeOf(sizes), strides, owner);
	}

	/// A new array filled by value(i, column).
	template <class Number, class Value>
	np::ndarray filled(const std::vector<std::size_t>& sizes, std::size_t columns, Value value)
	{
		const np::ndarray result = np::empty(shapeOf(sizes), np::dtype::get_builtin<Number>());
		auto*             to     = reinterpret_cast<Number*>(result.get_data());
		for (std::size_t i = 0; i < sizes[0]; i++)
			value(i, to + i * columns);
		return result;
	}

	void store(const ddem::PlaneTensor& tensor, double angle, double* to)
	{
		const ddem::PlaneTensor t = ddem::rotated(tensor, angle);
		to[0]                     = t.xx;
		to[1]                     = t.yy;
		to[2]                     = t.zz;
		to[3]                     = t.xy;
	}

	/// Tensors of the sub-elements, of(triangle), turned from the element's frame to global axes.
	template <class Tensors> np::ndarray tensors(const ddem::TriangleSystem& s, Tensors of)
	{
		return filled<double>({ s.triangles(), 3, 4 }, 12, [&](std::size_t i, double* to) {
			const std::array<ddem::PlaneTensor, 3> t     = of(i);
			const double                           angle = s.frameAngle(i);
			for (std::size_t k = 0; k < 3; k++)
				store(t[k], angle, to + 4 * k);
		});
	}

	np::ndarray bodyIds(const std::vector<shared_ptr<Body>>& bodies)
	{
		return filled<long>({ bodies.size() }, 1, [&](std::size_t i, long* to) { *to = bodies[i]->getId(); });
	}

} // namespace

boost::python::object sampleArray(Exposure& sample, const std::string& name)
{
	startNumpy();
	const auto&   s = sample.system;
	ddem::Motion& m = s->motion;
	struct Array {
		ddem::ReservedArray<double>* data;
		std::size_t                  columns;
	};
	const std::vector<std::pair<std::string, Array>> arrays {
		{ "nodePosition", { &m.node.position, 2 } }, { "nodeVelocity", { &m.node.velocity, 2 } },
		{ "nodeForce", { &m.node.force, 2 } },       { "nodeMass", { &m.node.mass, 1 } },
		{ "corePosition", { &m.core.position, 2 } }, { "coreVelocity", { &m.core.velocity, 2 } },
		{ "coreForce", { &m.core.force, 2 } },       { "coreMass", { &m.core.mass, 1 } },
		{ "coreRotation", { &m.spin.angle, 1 } },    { "coreSpin", { &m.spin.velocity, 1 } },
	};
	std::string names;
	for (const auto& [known, array] : arrays) {
		if (known == name) return view(s, *array.data, array.columns);
		names += (names.empty() ? "" : ", ") + known;
	}
	throw std::invalid_argument("DeformableEngine.array('" + name + "') is unknown; there are " + names);
}

namespace {

	/// A field of the laws: zero in groups that do not have it.
	np::ndarray fieldValues(const ddem::TriangleSystem& s, const std::string& name, bool isTensor)
	{
		const auto read = [&](std::size_t i, std::size_t k, double* to) {
			const ddem::LawGroup&   group = s.groupOf(i);
			const ddem::StateField* field = group.field(name);
			if (field) group.get(*field, i - group.begin, k, to);
			return field;
		};
		if (!isTensor)
			return filled<double>({ s.triangles(), 3 }, 3, [&](std::size_t i, double* to) {
				for (std::size_t k = 0; k < 3; k++)
					if (!read(i, k, to + k)) to[k] = 0;
			});
		return tensors(s, [&](std::size_t i) {
			std::array<ddem::PlaneTensor, 3> t {};
			for (std::size_t k = 0; k < 3; k++) {
				double                  v[4] = {};
				const ddem::StateField* f    = read(i, k, v);
				if (f && f->kind == ddem::FieldKind::InPlane) t[k] = { v[0], v[1], 0, v[2] };
				if (f && f->kind == ddem::FieldKind::Tensor) t[k] = { v[0], v[1], v[2], v[3] };
			}
			return t;
		});
	}

	/// What holds the nodes: against all other forces of the last step, zero where they are free [N].
	np::ndarray reactions(const ddem::Motion& m, const ddem::PlaneVector<double>& gravity)
	{
		const ddem::Points& node = m.node;
		std::vector<double> held(2 * node.size(), 0.);
		const double        g[2] = { gravity.x, gravity.y };
		for (std::size_t i = 0; i < held.size(); i++)
			if (node.inverseMass[i] == 0)
				held[i] = -(node.force[i] + node.mass[i / 2] * g[i % 2]
				            + (node.external.empty() ? 0. : node.external[i]));
		for (const ddem::NodeLoad& load : m.loads) {
			const double felt[2] = { load.force.x + load.resistance.x, load.force.y + load.resistance.y };
			for (std::size_t c = 0; c < 2; c++)
				if (const std::size_t i = 2 * load.node + c; node.inverseMass[i] == 0)
					held[i] -= felt[c];
		}
		return filled<double>({ node.size(), 2 }, 2, [&](std::size_t i, double* to) {
			to[0] = held[2 * i];
			to[1] = held[2 * i + 1];
		});
	}

} // namespace

boost::python::object sampleValues(const Exposure& sample, const std::string& name)
{
	startNumpy();
	const ddem::TriangleSystem& s = *sample.system;
	const std::size_t           n = s.triangles();
	const auto                  numbers = [&](auto value) {
                return filled<double>({ n }, 1, [&](std::size_t i, double* to) { *to = value(i); });
	};
	if (name == "nodeIds") return bodyIds(sample.nodes);
	if (name == "triangleIds") return bodyIds(sample.cores);
	if (name == "vertices")
		return filled<int>({ n, 3 }, 3, [&](std::size_t i, int* to) {
			for (std::size_t e = 0; e < 3; e++)
				to[e] = s.topology.vertex[e][i];
		});
	if (name == "reaction") {
		if (!std::isfinite(sample.lastGravity.x))
			throw std::runtime_error("DeformableEngine.values('reaction'): reactions are those of the last "
			                         "step, and none was made since the scene was read; make one");
		return reactions(s.motion, sample.lastGravity);
	}
	if (name == "tilePlace") {
		std::size_t tiles = 0; // of the groups before
		std::size_t known = 0;
		std::vector<long> place(n);
		for (const auto& g : s.group) {
			for (std::size_t i = 0; i < g->triangles(); i++)
				place[known++] = long(tiles * ddem::tileSize + i);
			tiles += g->tiles();
		}
		return filled<long>({ n }, 1, [&](std::size_t i, long* to) { *to = place[i]; });
	}
	if (name == "area") return numbers([&](std::size_t i) { return s.topology.reference(i).area(); });
	if (name == "rotation") return numbers([&](std::size_t i) { return s.frameAngle(i); });
	if (name == "fractureEnergy") return numbers([&](std::size_t i) { return sample.fractureEnergy(i); });
	if (name == "damage")
		return filled<double>({ n, 3 }, 3, [&](std::size_t i, double* to) {
			const auto sub = s.damage(i);
			std::copy(sub.begin(), sub.end(), to);
		});
	if (name == "stress") return tensors(s, [&](std::size_t i) { return sample.stress(i); });
	if (name == "strain") return tensors(s, [&](std::size_t i) { return s.strain(i); });
	// plastic strain and damage tensor are there for every law, zero where it has none
	std::string names;
	for (const auto& group : s.group)
		for (const ddem::StateField& f : group->fields()) {
			if (f.name == name) return fieldValues(s, name, f.kind != ddem::FieldKind::Scalar);
			if (names.find(f.name) == std::string::npos) names += ", " + f.name;
		}
	if (name == "plasticStrain" || name == "damageTensor") return fieldValues(s, name, true);
	throw std::invalid_argument(
	        "DeformableEngine.values('" + name
	        + "') is unknown; there are nodeIds, triangleIds, vertices, reaction, tilePlace, area, rotation, "
	          "fractureEnergy, damage, stress, strain, plasticStrain, damageTensor and the fields of these laws"
	        + names);
}

boost::python::list sampleFields(const Exposure& sample)
{
	boost::python::list   list;
	std::set<std::string> known;
	for (const auto& group : sample.system->group)
		for (const ddem::StateField& f : group->fields())
			if (known.insert(f.name).second)
				list.append(boost::python::make_tuple(f.name, f.unit, f.components()));
	return list;
}

boost::python::list sampleGroups(const Exposure& sample)
{
	boost::python::list list;
	for (const auto& pointer : sample.system->group) {
		const ddem::LawGroup& group = *pointer;
		boost::python::dict   entry;
		boost::python::list   on, off, fields;
		for (const ddem::LawEffect& effect : group.effectsOfLaw())
			(group.effects() & effect.bit ? on : off).append(std::string(effect.name));
		for (const ddem::StateField& f : group.fields())
			fields.append(f.name);
		entry["law"]        = std::string(group.name());
		entry["material"]   = sample.cores[group.begin]->material->label;
		entry["thickness"]  = group.constants.thickness;
		entry["first"]      = group.begin;
		entry["count"]      = group.triangles();
		entry["effects"]    = on;
		entry["effectsOff"] = off;
		entry["bytes"]      = group.bytesPerTriangle();
		entry["fields"]     = fields;
		list.append(entry);
	}
	return list;
}

} // namespace yade
