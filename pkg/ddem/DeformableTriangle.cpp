// GPL v2 or later, see LICENSE.
#include <pkg/ddem/DeformableTriangle.hpp>

#include <pkg/ddem/DeformableEngine.hpp>
#include <pkg/ddem/DeformableNode.hpp>

namespace yade {

DDEM_PLUGIN((DeformableNode)(DeformableTriangle))

const ddem::TriangleSystem& DeformableTriangle::state() const
{
	DeformableEngine::ofCurrentScene().current(); // assembles, and takes up what was changed in State
	if (!system) throw std::runtime_error("this DeformableTriangle is not in the scene (O.bodies): it has no state yet");
	return *system;
}

boost::python::list DeformableTriangle::globalTensors(const std::array<ddem::PlaneTensor, 3>& tensors) const
{
	const Real          angle = state().frameAngle(slot);
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

boost::python::list DeformableTriangle::concreteTensors(ddem::PlaneTensor ddem::ConcreteState::*member) const
{
	const ddem::TriangleSystem&      s = state();
	std::array<ddem::PlaneTensor, 3> tensors {};
	if (const ddem::ConcreteState* sub = s.concreteStates(slot))
		for (std::size_t k = 0; k < 3; k++)
			tensors[k] = sub[k].*member;
	return globalTensors(tensors);
}

boost::python::list DeformableTriangle::stress() const { return globalTensors(state().stress(slot)); }
boost::python::list DeformableTriangle::strain() const { return globalTensors(state().strain(slot)); }
boost::python::list DeformableTriangle::plasticStrain() const { return concreteTensors(&ddem::ConcreteState::plasticStrain); }
boost::python::list DeformableTriangle::damageTensor() const { return concreteTensors(&ddem::ConcreteState::damage); }
Real                DeformableTriangle::rotation() const { return state().frameAngle(slot); }
Real                DeformableTriangle::area() const { return state().reference(slot).area(); }

Real DeformableTriangle::damage() const
{
	const auto sub = state().subElementDamage(slot);
	return (sub[0] + sub[1] + sub[2]) / 3;
}

} // namespace yade
