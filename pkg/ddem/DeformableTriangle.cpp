// GPL v2 or later, see LICENSE.
#include <pkg/ddem/DeformableTriangle.hpp>

#include <pkg/ddem/DeformableEngine.hpp>
#include <pkg/ddem/DeformableNode.hpp>

namespace yade {

DDEM_PLUGIN((DeformableNode)(DeformableTriangle))

std::atomic<unsigned long> DeformableTriangle::changes { 0 };

shared_ptr<Exposure> DeformableTriangle::current() const
{
	if (const auto known = DeformableEngine::currentOf(exposure.lock(), row)) return known;
	DeformableEngine::readScene(); // not read yet
	if (const auto known = DeformableEngine::currentOf(exposure.lock(), row)) return known;
	throw std::runtime_error("this DeformableTriangle has no state: it is not in the scene (O.bodies), or no "
	                         "DeformableEngine in O.engines takes it");
}

boost::python::list
DeformableTriangle::globalTensors(const Exposure& in, const std::array<ddem::PlaneTensor, 3>& tensors) const
{
	const Real          angle = in.system->frameAngle(row);
	boost::python::list result;
	for (const auto& tensor : tensors) {
		const ddem::PlaneTensor t = ddem::rotated(tensor, angle);
		Matrix3r                m = Matrix3r::Zero();
		m(0, 0)                   = t.xx;
		m(1, 1)                   = t.yy;
		m(2, 2)                   = t.zz;
		m(0, 1) = m(1, 0) = t.xy;
		result.append(m);
	}
	return result;
}

boost::python::list DeformableTriangle::fieldTensors(const char* name) const
{
	const auto                       in    = current();
	const ddem::LawGroup&            group = in->system->groupOf(row);
	std::array<ddem::PlaneTensor, 3> tensors {};
	const ddem::StateField*          field = group.field(name);
	if (field && field->kind == ddem::FieldKind::Tensor)
		for (std::size_t k = 0; k < 3; k++) {
			double t[4];
			group.get(*field, row - group.begin, k, t);
			tensors[k] = { t[0], t[1], t[2], t[3] };
		}
	return globalTensors(*in, tensors);
}

boost::python::list DeformableTriangle::stress() const
{
	const auto in = current();
	return globalTensors(*in, in->stress(row));
}

boost::python::list DeformableTriangle::strain() const
{
	const auto in = current();
	return globalTensors(*in, in->system->strain(row));
}

boost::python::list DeformableTriangle::plasticStrain() const { return fieldTensors("plasticStrain"); }
boost::python::list DeformableTriangle::damageTensor() const { return fieldTensors("damageTensor"); }
Real                DeformableTriangle::rotation() const { return current()->system->frameAngle(row); }
Real                DeformableTriangle::area() const { return current()->system->topology.reference(row).area(); }

Real DeformableTriangle::damage() const
{
	const auto sub = current()->system->damage(row);
	return (sub[0] + sub[1] + sub[2]) / 3;
}

} // namespace yade
