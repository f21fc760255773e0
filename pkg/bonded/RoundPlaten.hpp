// GPL v2 or later, see LICENSE.
// Rigid rollers and curved jaws: shape, bound and geometry of their contacts.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>

namespace yade {

class RoundPlaten : public Shape {
public:
	virtual ~RoundPlaten() = default;
	void validate() const;
	void postLoad(RoundPlaten&) { validate(); }
	/// Overlap with a sphere [m], negative where they are apart, and the normal from here to its centre.
	/// \returns whether its centre is opposite to the surface
	bool overlap(const Se3r& place, const Vector3r& centre, Real sphereRadius, Real& depth, Vector3r& normal) const;

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(RoundPlaten, Shape,
		"A rigid part of a cylinder's surface that spheres touch: a roller, from outside, as supports and load "
		"of a bending test are; or, :yref:`concave<RoundPlaten.concave>`, a jaw, from inside, as those of the "
		"Brazilian test. Its axis is the body's local z through :yref:`State.pos`, the middle of a jaw is "
		"towards local y. ``ddem.bonded.three_point_bending`` and ``ddem.bonded.brazilian`` make them; "
		":yref:`Ig2_RoundPlaten_Sphere_ScGeom` and :yref:`Bo1_RoundPlaten_Aabb` belong to it. A body of this "
		"shape stands still or is driven by an engine.\n\n"
		"Errors: ValueError for a radius or a length that is not positive, a half angle that is not between "
		"0 and π/2. Limits: its ends and the edges of a jaw touch nothing; YADE's 3-D view does not draw it.",
		((Real,radius,NaN,Attr::triggerPostLoad,"Of the cylinder [m]"))
		((Real,length,NaN,Attr::triggerPostLoad,"Along its axis [m]"))
		((bool,concave,false,,"Whether it is touched from inside"))
		((Real,halfAngle,Mathr::PI/4,Attr::triggerPostLoad,"Of a jaw, to each side of its middle [rad]")),
		createIndex();,
		.def("validate",&RoundPlaten::validate,"ValueError naming what is out of range.")
	);
	// clang-format on
	REGISTER_CLASS_INDEX(RoundPlaten, Shape);
};
REGISTER_SERIALIZABLE(RoundPlaten);

class Bo1_RoundPlaten_Aabb : public BoundFunctor {
public:
	void go(const shared_ptr<Shape>& shape, shared_ptr<Bound>& bound, const Se3r& se3, const Body*) override;
	FUNCTOR1D(RoundPlaten);
	// clang-format off
	YADE_CLASS_BASE_DOC(Bo1_RoundPlaten_Aabb, BoundFunctor,
		"Box around a :yref:`RoundPlaten`; of a jaw around its arc alone.");
	// clang-format on
};
REGISTER_SERIALIZABLE(Bo1_RoundPlaten_Aabb);

class Ig2_RoundPlaten_Sphere_ScGeom : public IGeomFunctor {
public:
	bool
	go(const shared_ptr<Shape>& platen, const shared_ptr<Shape>& sphere, const State& state1, const State& state2,
	   const Vector3r& shift2, const bool& force, const shared_ptr<Interaction>& I) override;
	FUNCTOR2D(RoundPlaten, Sphere);
	DEFINE_FUNCTOR_ORDER_2D(RoundPlaten, Sphere);
	// clang-format off
	YADE_CLASS_BASE_DOC(Ig2_RoundPlaten_Sphere_ScGeom, IGeomFunctor,
		":yref:`ScGeom` of a :yref:`RoundPlaten` and a :yref:`Sphere`. With the distance *d* of the sphere's "
		"centre from the axis the overlap is :math:`R+r-d` on a roller, :math:`d+r-R` in a jaw; the platen "
		"counts as the sphere's mirror image, as a :yref:`Wall` does.");
	// clang-format on
};
REGISTER_SERIALIZABLE(Ig2_RoundPlaten_Sphere_ScGeom);

} // namespace yade
