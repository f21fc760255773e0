// GPL v2 or later, see LICENSE
// Conforming triangulation of a polygonal region by CGAL's Delaunay mesh generator.

#include <pkg/ddem/mesh/Mesher.hpp>

#include <CGAL/Base_with_time_stamp.h>
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/lloyd_optimize_mesh_2.h>
#include <CGAL/mark_domain_in_triangulation.h>

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <unordered_map>

namespace yade::ddem::mesh {

namespace {
	using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
	// Time stamps order the generator's sets of vertices by creation instead of by address, so that the same input
	// gives the same mesh in every process.
	using Vertex     = CGAL::Base_with_time_stamp<CGAL::Delaunay_mesh_vertex_base_2<Kernel>>;
	using Face       = CGAL::Delaunay_mesh_face_base_2<Kernel>;
	using Base       = CGAL::
	        Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertex, Face>>;
	using FaceHandle = Base::Face_handle;

	// A triangulation that looks for the place of a new node near the node touched last. Smoothing takes every node
	// out and puts it back nearby; searching for its place from a far corner each time would make it quadratic
	// in the number of nodes.
	class Cdt : public Base {
		Vertex_handle last;

	public:
		Vertex_handle insert(const Point& position, FaceHandle start = FaceHandle())
		{
			if (start == FaceHandle() && last != Vertex_handle()) start = last->face();
			return last = Base::insert(position, start);
		}
		void remove(Vertex_handle vertex)
		{
			last = vertex->face()->vertex(Base::ccw(vertex->face()->index(vertex)));
			Base::remove(vertex);
		}
		// Number the nodes along a curve that fills the plane, so that the way from one node to the next is
		// short. Forgets what is inside.
		void renumber()
		{
			std::vector<Point>                               points;
			std::unordered_map<Vertex_handle, std::size_t>   index;
			std::vector<std::pair<std::size_t, std::size_t>> constraints;
			for (const Vertex_handle vertex : finite_vertex_handles()) {
				index[vertex] = points.size();
				points.push_back(vertex->point());
			}
			for (const Edge& edge : constrained_edges())
				constraints.emplace_back(
				        index.at(edge.first->vertex(cw(edge.second))),
				        index.at(edge.first->vertex(ccw(edge.second))));
			clear();
			last = Vertex_handle();
			insert_constraints(points.begin(), points.end(), constraints.begin(), constraints.end());
		}
	};

	Kernel::Point_2 centroid(FaceHandle face)
	{
		return CGAL::centroid(face->vertex(0)->point(), face->vertex(1)->point(), face->vertex(2)->point());
	}

	// CGAL's criterion (angle bound first, then longest edge), with the size taken from the field at
	// each triangle's centroid.
	class SizeFieldCriteria : public CGAL::Delaunay_mesh_size_criteria_2<Cdt> {
		using Uniform = CGAL::Delaunay_mesh_size_criteria_2<Cdt>;
		const Criteria* wanted;

	public:
		SizeFieldCriteria(const Criteria& criteria)
		        : CGAL::Delaunay_mesh_criteria_2<Cdt>(std::pow(std::sin(criteria.smallestAngle), 2))
		        , wanted(&criteria)
		{
		}

		class Is_bad {
			const SizeFieldCriteria* field;

		public:
			Is_bad(const SizeFieldCriteria& criteria)
			        : field(&criteria)
			{
			}
			CGAL::Mesh_2::Face_badness operator()(const Quality quality) const { return at(0)(quality); }
			CGAL::Mesh_2::Face_badness operator()(FaceHandle face, Quality& quality) const
			{
				const Kernel::Point_2 middle = centroid(face);
				return at(
				        field->wanted->longestEdgeFactor
				        * field->wanted->size(middle.x(), middle.y()))(face, quality);
			}

		private:
			Uniform::Is_bad at(double longestEdge) const
			{
				return { field->bound(), longestEdge, field->traits };
			}
		};
		Is_bad is_bad_object() const { return { *this }; }
	};

	Kernel::Point_2 toKernel(const Point& p) { return { p.x, p.y }; }

	// A point well inside a simple ring: the centroid of the largest triangle of its triangulation.
	Kernel::Point_2 insideOf(const std::vector<int>& ring, const std::vector<Point>& points)
	{
		Cdt                          cdt;
		std::vector<Kernel::Point_2> corners;
		for (const int i : ring)
			corners.push_back(toKernel(points[std::size_t(i)]));
		cdt.insert_constraint(corners.begin(), corners.end(), true);
		CGAL::mark_domain_in_triangulation(cdt);
		FaceHandle largest;
		double     area = 0;
		for (const FaceHandle face : cdt.finite_face_handles()) {
			if (face->is_in_domain() && cdt.triangle(face).area() > area) {
				largest = face;
				area    = cdt.triangle(face).area();
			}
		}
		if (largest == FaceHandle()) throw std::invalid_argument("a hole has no area");
		return centroid(largest);
	}

	void refine(Cdt& cdt, const std::vector<Kernel::Point_2>& seeds, const Criteria& criteria)
	{
		CGAL::Delaunay_mesher_2<Cdt, SizeFieldCriteria> mesher(cdt, SizeFieldCriteria(criteria));
		mesher.set_seeds(seeds.begin(), seeds.end());
		mesher.init();
		for (std::size_t step = 0; !mesher.is_refinement_done(); ++step) {
			mesher.step_by_step_refine_mesh();
			if (step % 1024 == 0) criteria.tick();
			if (cdt.number_of_faces() > criteria.largestCount) {
				std::ostringstream message;
				message << "the mesh has more than " << criteria.largestCount
				        << " triangles and is not finished; use a larger size, or raise limit=";
				throw std::invalid_argument(message.str());
			}
		}
	}
}

double guaranteedAngle() { return std::asin(std::sqrt(1. / 8)); }

Triangulation triangulate(const Domain& domain, const Criteria& criteria)
{
	Cdt                             cdt;
	std::vector<Cdt::Vertex_handle> vertices;
	for (const Point& point : domain.points)
		vertices.push_back(cdt.insert(toKernel(point)));
	for (const auto& [a, b] : domain.segments)
		cdt.insert_constraint(vertices[std::size_t(a)], vertices[std::size_t(b)]);
	std::vector<Kernel::Point_2> seeds;
	for (const auto& hole : domain.holes)
		seeds.push_back(insideOf(hole, domain.points));

	refine(cdt, seeds, criteria);
	if (criteria.smoothing > 0) {
		cdt.renumber();
		CGAL::Delaunay_mesher_2<Cdt, SizeFieldCriteria>::mark_facets(cdt, seeds.begin(), seeds.end());
		CGAL::lloyd_optimize_mesh_2(
		        cdt, CGAL::parameters::number_of_iterations(std::size_t(criteria.smoothing)).seeds(seeds));
		// Smoothing evens the edges out, a few grow a little; splitting these again would undo its work,
		// so only the angle bound is restored strictly.
		Criteria lenient = criteria;
		lenient.longestEdgeFactor *= 1.25;
		refine(cdt, seeds, lenient);
	}

	Triangulation                               result;
	std::unordered_map<Cdt::Vertex_handle, int> index;
	for (const FaceHandle face : cdt.finite_face_handles()) {
		if (!face->is_in_domain()) continue;
		std::array<int, 3> corners;
		for (int k = 0; k < 3; ++k) {
			const auto [place, isNew] = index.try_emplace(face->vertex(k), int(result.nodes.size()));
			if (isNew)
				result.nodes.push_back({ face->vertex(k)->point().x(), face->vertex(k)->point().y() });
			corners[std::size_t(k)] = place->second;
		}
		result.triangles.push_back(corners);
	}
	return result;
}

} // namespace yade::ddem::mesh
