// GPL v2 or later, see LICENSE.
// Pressure of a flexible membrane on particles beneath it.
#include <pkg/bonded/kernel/Membrane.hpp>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace yade::ddem {

Membrane::Membrane(
        std::vector<Face> facesHere, std::vector<Face> endsHere, std::vector<std::int32_t> carriersHere,
        std::vector<Vector> offsetsHere)
        : faces(std::move(facesHere))
        , ends(std::move(endsHere))
        , carriers(std::move(carriersHere))
        , offsets(std::move(offsetsHere))
{
	if (carriers.size() != offsets.size())
		throw std::invalid_argument(
		        std::to_string(carriers.size()) + " carriers and " + std::to_string(offsets.size())
		        + " offsets; each node needs both");
	for (const std::int32_t carrier : carriers)
		if (carrier < 0) throw std::invalid_argument("carrier " + std::to_string(carrier) + " of a node");
	checkNodes(faces, "face");
	checkNodes(ends, "end");

	const std::size_t count
	        = carriers.empty() ? 0 : std::size_t(*std::max_element(carriers.begin(), carriers.end())) + 1;
	begins.assign(count + 1, 0);
	const auto particleOf = [&](std::int32_t node) { return std::size_t(carriers[std::size_t(node)]); };
	for (const Face& face : faces)
		for (const std::int32_t node : face)
			begins[particleOf(node) + 1]++;
	for (std::size_t i = 0; i < count; i++)
		begins[i + 1] += begins[i];
	corners.resize(3 * faces.size());
	std::vector<std::size_t> next(begins.begin(), begins.end() - 1);
	for (std::size_t f = 0; f < faces.size(); f++)
		for (const std::int32_t node : faces[f])
			corners[next[particleOf(node)]++] = std::int32_t(f);
	areas.resize(faces.size());
}

void Membrane::checkNodes(const std::vector<Face>& of, const char* what) const
{
	for (const Face& face : of)
		for (const std::int32_t node : face)
			if (node < 0 || std::size_t(node) >= carriers.size())
				throw std::invalid_argument(
				        std::string(what) + " with node " + std::to_string(node) + ", but there are "
				        + std::to_string(carriers.size()));
}

Membrane::Vector Membrane::areaOf(const std::vector<Vector>& centres, const Face& face) const
{
	const Vector a = node(centres, face[0]);
	return 0.5 * (node(centres, face[1]) - a).cross(node(centres, face[2]) - a);
}

void Membrane::forces(const std::vector<Vector>& centres, double pressure, std::vector<Vector>& result)
{
	const long   faceCount = long(faces.size()), count = long(particles());
	const double third = -pressure / 3;
	result.resize(std::size_t(count));
	// Two passes: each particle sums its faces in their order, whichever thread it is.
#pragma omp parallel
	{
#pragma omp for schedule(static)
		for (long f = 0; f < faceCount; f++)
			areas[std::size_t(f)] = areaOf(centres, faces[std::size_t(f)]);
#pragma omp for schedule(static)
		for (long i = 0; i < count; i++) {
			Vector sum = Vector::Zero();
			for (std::size_t k = begins[std::size_t(i)]; k < begins[std::size_t(i) + 1]; k++)
				sum += areas[std::size_t(corners[k])];
			result[std::size_t(i)] = third * sum;
		}
	}
}

double Membrane::volume(const std::vector<Vector>& centres) const
{
	if (offsets.empty()) return 0;
	const Vector origin = node(centres, 0); // near by, so that little is lost far from the scene's origin
	double       sum    = 0;
	for (const auto* const part : { &faces, &ends })
		for (const Face& face : *part)
			sum += (node(centres, face[0]) - origin).dot(areaOf(centres, face));
	return sum / 3;
}

double Membrane::area(const std::vector<Vector>& centres) const
{
	double sum = 0;
	for (const Face& face : faces)
		sum += areaOf(centres, face).norm();
	return sum;
}

double Membrane::turned(const std::vector<Vector>& centres, const std::vector<Vector>& normals) const
{
	double all = 0, inward = 0;
	for (std::size_t f = 0; f < faces.size(); f++) {
		const Vector here = areaOf(centres, faces[f]);
		const double size = here.norm();
		all += size;
		if (here.dot(normals[f]) < 0) inward += size;
	}
	return all > 0 ? inward / all : 0;
}

} // namespace yade::ddem
