// GPL v2 or later, see LICENSE.
// The deformable triangle particle as YADE sees it: a core body with three node bodies.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>
#include <pkg/ddem/kernel/triangles/TriangleSystem.hpp>

#include <atomic>
#include <boost/weak_ptr.hpp>

namespace yade {

class Exposure;

class DeformableTriangle : public Shape {
public:
	virtual ~DeformableTriangle() = default;

	/// Where the engine keeps this triangle's state; empty until it has read the scene.
	shared_ptr<ddem::TriangleSystem> system;
	boost::weak_ptr<Exposure>          exposure;
	std::size_t                      row = 0;

	/// What it says beside its nodes.
	struct Values {
		Real     thickness, fractureEnergy, bandFactor;
		Matrix3r initialDamage;
		std::vector<Matrix3r> initialStress;

		bool operator==(const Values& o) const
		{
			return thickness == o.thickness && fractureEnergy == o.fractureEnergy
			        && bandFactor == o.bandFactor && initialDamage == o.initialDamage
			        && initialStress == o.initialStress;
		}
	};
	Values values() const { return { thickness, fractureEnergy, bandFactor, initialDamage, initialStress }; }
	/// Counts what was said by all triangles, so that an engine need not ask each.
	static std::atomic<unsigned long> changes;
	void                              postLoad(DeformableTriangle&) { changes++; }

	boost::python::list stress() const;
	boost::python::list strain() const;
	boost::python::list plasticStrain() const;
	boost::python::list damageTensor() const;
	Real                damage() const;
	Real                rotation() const;
	Real                area() const;

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(DeformableTriangle, Shape,
		"Deformable triangle of plane strain [Zubelewicz2018]_: its body is the rigid core (translation and "
		"rotation of the mass centre), three :yref:`DeformableNode` bodies are its vertices, and the interior "
		"in between deforms by shape functions in three sub-elements (centre, vertex k, vertex k+1). Moved by "
		":yref:`DeformableEngine`, which also keeps stress and damage; what is read here is always the current "
		"state.\n\n"
		"Tensors are in global axes, one per sub-element, tension positive.",
		((Vector3i,nodes,Vector3i(-1,-1,-1),,
			"Ids of the three node bodies, counter-clockwise in the xy plane."))
		((Real,thickness,1,Attr::triggerPostLoad,"Thickness [m] of the plane-strain slice."))
		((Real,fractureEnergy,-1,Attr::triggerPostLoad,
			"This triangle's own fracture energy :math:`G_f`, in the unit of its material's (J/m³ for "
			":yref:`ConcreteDamageMat`, J/m² for :yref:`ScalarDamageMat`); negative: the material's."))
		((Real,bandFactor,1,Attr::triggerPostLoad,
			"Factor [-] on the fracture energy once flow has localised (damage :math:`\\Omega_D` above "
			"0.5), from the crack band: ddem.append(crack_band=)."))
		((Matrix3r,initialDamage,Matrix3r::Zero(),Attr::triggerPostLoad,
			"Pre-existing damage tensor :math:`\\Omega_0` [-] of its sub-elements, symmetric, in the "
			"reference axes; components xz and yz must be zero."))
		((vector<Matrix3r>,initialStress,,Attr::triggerPostLoad,
			"Stress [Pa] that it has where it is not strained, in the reference axes, tension positive: "
			"none, one for the triangle, or one for each sub-element (centre, vertex k, vertex k+1), taken "
			"at its centroid. Its law takes it for its own (``ddem.append(initial_stress=)``); components "
			"xz and yz must be zero.")),
		createIndex();,
		.add_property("stress",&DeformableTriangle::stress,
			"Stress [Pa] of the three sub-elements, list of Matrix3.")
		.add_property("strain",&DeformableTriangle::strain,
			"Strain [-] of the three sub-elements, list of Matrix3.")
		.add_property("plasticStrain",&DeformableTriangle::plasticStrain,
			"Plastic strain [-] of the three sub-elements, list of Matrix3; zero in elastic triangles.")
		.add_property("damageTensor",&DeformableTriangle::damageTensor,
			"Damage tensor :math:`\\Omega` [-] of the three sub-elements, list of Matrix3; zero in elastic "
			"triangles.")
		.add_property("damage",&DeformableTriangle::damage,
			"Damage :math:`\\eta/\\eta_{max}` [-], mean of the three sub-elements: 0 intact, 1 broken.")
		.add_property("rotation",&DeformableTriangle::rotation,
			"Rotation [rad] of the element's frame about z, counter-clockwise; counts full turns where "
			"cores rotate ('cosserat').")
		.add_property("area",&DeformableTriangle::area,"Area [m²] in the reference state.")
	);
	// clang-format on
	REGISTER_CLASS_INDEX(DeformableTriangle, Shape);

private:
	shared_ptr<Exposure> current() const;
	boost::python::list  globalTensors(const Exposure& in, const std::array<ddem::PlaneTensor, 3>& tensors) const;
	boost::python::list  fieldTensors(const char* name) const;
};
REGISTER_SERIALIZABLE(DeformableTriangle);

} // namespace yade
