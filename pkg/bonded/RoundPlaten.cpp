// GPL v2 or later, see LICENSE.
// Rigid rollers and curved jaws: shape, bound and geometry of their contacts.
#include <pkg/bonded/RoundPlaten.hpp>
#include <pkg/bonded/kernel/RoundContact.hpp>
#include <pkg/ddem/kernel/algebra/EigenSpace.hpp>

#include <sstream>

namespace yade {

DDEM_PLUGIN((RoundPlaten)(Bo1_RoundPlaten_Aabb)(Ig2_RoundPlaten_Sphere_ScGeom))

void RoundPlaten::validate() const
{
	const auto refuse = [](const char* name, Real value, const char* complaint) {
		std::ostringstream text;
		text << "RoundPlaten: " << name << " = " << value << " " << complaint;
		throw std::invalid_argument(text.str());
	};
	if (!(radius > 0 && std::isfinite(radius))) refuse("radius", radius, "m must be positive and finite");
	if (!(length > 0 && std::isfinite(length))) refuse("length", length, "m must be positive and finite");
	if (!(halfAngle > 0 && halfAngle <= Mathr::PI / 2))
		refuse("halfAngle", halfAngle, "rad must lie between 0 and π/2");
}

bool RoundPlaten::overlap(
        const Se3r& place, const Vector3r& centre, Real sphereRadius, Real& depth, Vector3r& normal) const
{
	const Vector3r local = place.orientation.conjugate() * (centre - place.position);
	const auto     touch = ddem::touchOf(
                { radius, length, concave, halfAngle }, ddem::spaceVector(local), sphereRadius);
	depth  = touch.depth;
	normal = place.orientation * ddem::eigenVector(touch.normal);
	return touch.there;
}

void Bo1_RoundPlaten_Aabb::go(const shared_ptr<Shape>& shape, shared_ptr<Bound>& bound, const Se3r& se3, const Body*)
{
	const auto& platen = static_cast<const RoundPlaten&>(*shape);
	if (!bound) bound = boost::make_shared<Aabb>();
	const Real across = platen.radius * (platen.concave ? math::sin(platen.halfAngle) : 1),
	           low    = platen.radius * (platen.concave ? math::cos(platen.halfAngle) : -1);
	auto& box = static_cast<Aabb&>(*bound);
	box.min   = Vector3r::Constant(std::numeric_limits<Real>::infinity());
	box.max   = -box.min;
	for (int corner = 0; corner < 8; corner++) {
		const Vector3r local(
		        corner & 1 ? across : -across, corner & 2 ? platen.radius : low,
		        platen.length * (corner & 4 ? 0.5 : -0.5));
		const Vector3r at = se3.position + se3.orientation * local;
		box.min           = box.min.cwiseMin(at);
		box.max           = box.max.cwiseMax(at);
	}
}

bool Ig2_RoundPlaten_Sphere_ScGeom::go(
        const shared_ptr<Shape>& platen, const shared_ptr<Shape>& sphere, const State& state1, const State& state2,
        const Vector3r& shift2, const bool& force, const shared_ptr<Interaction>& I)
{
	const Real radius = static_cast<const Sphere&>(*sphere).radius;
	Real       depth  = 0;
	Vector3r   normal = Vector3r::Zero();
	const bool there  = static_cast<const RoundPlaten&>(*platen).overlap(
                state1.se3, state2.pos + shift2, radius, depth, normal);
	if ((!there || depth < 0) && !I->isReal() && !force) return false;
	if (!there) return false;
	const bool isNew = !I->geom;
	if (isNew) I->geom = boost::make_shared<ScGeom>();
	auto& geom            = static_cast<ScGeom&>(*I->geom);
	geom.radius1          = geom.radius2 = radius;
	geom.penetrationDepth = depth;
	geom.contactPoint     = state2.pos + shift2 - (radius - 0.5 * depth) * normal;
	geom.precompute(state1, state2, scene, I, normal, isNew, shift2, true);
	return true;
}

} // namespace yade
