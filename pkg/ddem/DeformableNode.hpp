// GPL v2 or later, see LICENSE.
// The vertex that deformable triangles share.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>

namespace yade {

class DeformableNode : public Shape {
public:
	virtual ~DeformableNode() = default;

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR(DeformableNode, Shape,
		"External node of :yref:`DeformableTriangle`: a point with mass, shared by all triangles that meet "
		"there, moved by :yref:`DeformableEngine` in the xy plane. Its reference position [m] is "
		":yref:`State.refPos`, where its triangles are free of stress. Fix or drive it by "
		":yref:`State.blockedDOFs` and :yref:`State.vel`.",
		,
		createIndex();
	);
	// clang-format on
	REGISTER_CLASS_INDEX(DeformableNode, Shape);
};
REGISTER_SERIALIZABLE(DeformableNode);

} // namespace yade
