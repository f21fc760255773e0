// GPL v2 or later, see LICENSE.
// What a material of deformable triangles owes, made from its law's two lists: parameters and effects.
//
// A new material is a pair of files. Its header:
//
//     class MyMat : public DeformableElastMat {
//     public:
//             virtual ~MyMat() = default;
//             DDEM_LAW_OF_MATERIAL(MyMat, ddem::MyLaw, MY_PARAMETERS, MY_EFFECTS)
//
//             YADE_CLASS_BASE_DOC_ATTRS_CTOR(MyMat, DeformableElastMat, "What it is …",
//                     MY_PARAMETERS(DDEM_ATTRIBUTE) MY_EFFECTS(DDEM_SWITCH),
//                     createIndex(); takeElasticityOfLaw();
//             );
//             REGISTER_CLASS_INDEX(MyMat, DeformableElastMat);
//     };
//     REGISTER_SERIALIZABLE(MyMat);
//
// and a source file with DDEM_PLUGIN((MyMat)).
#pragma once

#include <pkg/ddem/DeformableElastMat.hpp>
#include <pkg/ddem/ParameterAttributes.hpp>
#include <pkg/ddem/kernel/triangles/LawGroup.hpp>

// A switch is called as its effect.
#define DDEM_SWITCH(name, bit, doc) ((bool, name, true, Attr::triggerPostLoad, doc))
#define DDEM_ADD_EFFECT(name, bit, doc) mask |= name ? unsigned(bit) : 0;

#define DDEM_LAW_OF_MATERIAL(Class, Law, PARAMETERS, EFFECTS) \
	/** The parameters as the law takes them. */ \
	Law::Parameters parameters() const \
	{ \
		Law::Parameters p; \
		copyElasticity(p); \
		PARAMETERS(DDEM_COPY_PARAMETER) \
		return p; \
	} \
	/** Mask of the effects that are switched on. */ \
	unsigned switchedOn() const override \
	{ \
		unsigned mask = 0; \
		using namespace ddem; \
		EFFECTS(DDEM_ADD_EFFECT) \
		return mask; \
	} \
	LawOfMaterial law() const override { return lawOf<Law>(typeid(Class), parameters(), switchedOn()); } \
	void          postLoad(Class&) { validate(); } \
	void          takeElasticityOfLaw() \
	{ \
		const Law::Parameters p; \
		setModuli(p.bulk, p.shear); \
		density           = p.density; \
		rotationStiffness = p.rotationStiffness; \
	}
