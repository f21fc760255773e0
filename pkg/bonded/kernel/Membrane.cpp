// GPL v2 or later, see LICENSE.
// Pressure of a flexible membrane on particles beneath it.
#include <pkg/bonded/kernel/Membrane.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace yade::ddem {

namespace {

	using Vector = Membrane::Vector;

	/// Area vector of a face [m²].
	Vector areaOf(const std::vector<Vector>& places, const Membrane::Face& face)
	{
		const Vector& a = places[std::size_t(face[0])];
		return 0.5 * (places[std::size_t(face[1])] - a).cross(places[std::size_t(face[2])] - a);
	}

} // namespace

/// \param each calls what it is given with the number of a list and an item, for all items, twice the same
template <class Item, class Each> Membrane::Lists<Item> Membrane::listed(std::size_t count, const Each& each)
{
	Lists<Item> lists;
	lists.begins.assign(count + 1, 0);
	each([&](std::int32_t list, const Item&) { lists.begins[std::size_t(list) + 1]++; });
	for (std::size_t i = 0; i < count; i++)
		lists.begins[i + 1] += lists.begins[i];
	lists.items.resize(lists.begins.back());
	std::vector<std::size_t> next(lists.begins.begin(), lists.begins.end() - 1);
	each([&](std::int32_t list, const Item& item) { lists.items[next[std::size_t(list)]++] = item; });
	return lists;
}

Membrane::Membrane(
        const std::vector<Face>& facesHere, const std::vector<Face>& endsHere, const std::vector<Support>& supports,
        const std::vector<Vector>& offsetsHere)
        : faces(facesHere)
        , ends(endsHere)
        , offsets(offsetsHere)
{
	checkNodes(faces, "face");
	checkNodes(ends, "end");
	std::size_t count = 0;
	for (const Support& support : supports) {
		if (support.node < 0 || std::size_t(support.node) >= offsets.size())
			throw std::invalid_argument(
			        "support of node " + std::to_string(support.node) + ", but there are "
			        + std::to_string(offsets.size()) + " nodes");
		if (support.particle < 0)
			throw std::invalid_argument("support by particle " + std::to_string(support.particle));
		count = std::max(count, std::size_t(support.particle) + 1);
	}
	particlesOf = listed<Share>(offsets.size(), [&](const auto& take) {
		for (const Support& support : supports)
			take(support.node, { support.particle, support.weight });
	});
	nodesOf     = listed<Share>(count, [&](const auto& take) {
                for (const Support& support : supports)
                        take(support.particle, { support.node, support.weight });
        });
	facesOf     = listed<std::int32_t>(offsets.size(), [&](const auto& take) {
                for (std::size_t f = 0; f < faces.size(); f++)
                        for (const std::int32_t node : faces[f])
                                take(node, std::int32_t(f));
        });
	checkWeights();
	places.resize(offsets.size());
	pushes.resize(offsets.size());
	areas.resize(faces.size());
}

void Membrane::checkNodes(const std::vector<Face>& of, const char* what) const
{
	for (const Face& face : of)
		for (const std::int32_t node : face)
			if (node < 0 || std::size_t(node) >= offsets.size())
				throw std::invalid_argument(
				        std::string(what) + " with node " + std::to_string(node) + ", but there are "
				        + std::to_string(offsets.size()) + " nodes");
}

/// Else part of the pressure would be lost, or the membrane would not follow a translation.
void Membrane::checkWeights() const
{
	for (std::size_t i = 0; i < offsets.size(); i++) {
		double sum = 0;
		for (std::size_t k = particlesOf.begins[i]; k < particlesOf.begins[i + 1]; k++)
			sum += particlesOf.items[k].weight;
		if (!(std::abs(sum - 1) < 1e-9))
			throw std::invalid_argument(
			        "weights of node " + std::to_string(i) + " add up to " + std::to_string(sum)
			        + ", not 1");
	}
}

Membrane::Vector Membrane::node(const std::vector<Vector>& centres, std::size_t i) const
{
	Vector place = offsets[i];
	for (std::size_t k = particlesOf.begins[i]; k < particlesOf.begins[i + 1]; k++)
		place += particlesOf.items[k].weight * centres[std::size_t(particlesOf.items[k].of)];
	return place;
}

std::vector<Membrane::Vector> Membrane::nodes(const std::vector<Vector>& centres) const
{
	std::vector<Vector> result(offsets.size());
	for (std::size_t i = 0; i < offsets.size(); i++)
		result[i] = node(centres, i);
	return result;
}

void Membrane::forces(const std::vector<Vector>& centres, double pressure, std::vector<Vector>& result)
{
	const long nodeCount = long(offsets.size()), faceCount = long(faces.size()), count = long(particles());
	result.resize(std::size_t(count));
	// Each pass gathers in a fixed order, whichever thread it is.
#pragma omp parallel
	{
#pragma omp for schedule(static)
		for (long i = 0; i < nodeCount; i++)
			places[std::size_t(i)] = node(centres, std::size_t(i));
#pragma omp for schedule(static)
		for (long f = 0; f < faceCount; f++)
			areas[std::size_t(f)] = areaOf(places, faces[std::size_t(f)]);
#pragma omp for schedule(static)
		for (long n = 0; n < nodeCount; n++) {
			const auto i   = std::size_t(n);
			Vector     sum = Vector::Zero();
			for (std::size_t k = facesOf.begins[i]; k < facesOf.begins[i + 1]; k++)
				sum += areas[std::size_t(facesOf.items[k])];
			pushes[i] = -pressure / 3 * sum;
		}
#pragma omp for schedule(static)
		for (long n = 0; n < count; n++) {
			const auto i   = std::size_t(n);
			Vector     sum = Vector::Zero();
			for (std::size_t k = nodesOf.begins[i]; k < nodesOf.begins[i + 1]; k++)
				sum += nodesOf.items[k].weight * pushes[std::size_t(nodesOf.items[k].of)];
			result[i] = sum;
		}
	}
}

void Membrane::takeMoment(const std::vector<Vector>& places, const Vector& axis, std::vector<Vector>& forces)
{
	if (places.empty()) return;
	Vector middle = Vector::Zero();
	for (const Vector& place : places)
		middle += place;
	middle /= double(places.size());
	double moment = 0, inertia = 0;
	for (std::size_t i = 0; i < places.size(); i++) {
		const Vector lever = axis.cross(places[i] - middle);
		moment += lever.dot(forces[i]);
		inertia += lever.squaredNorm();
	}
	if (!(inertia > 0)) return;
	for (std::size_t i = 0; i < places.size(); i++)
		forces[i] -= moment / inertia * axis.cross(places[i] - middle);
}

double Membrane::volume(const std::vector<Vector>& centres) const
{
	if (offsets.empty()) return 0;
	const auto   at     = nodes(centres);
	const Vector origin = at[0]; // near by, so that little is lost far from the scene's origin
	double       sum    = 0;
	for (const auto* const part : { &faces, &ends })
		for (const Face& face : *part)
			sum += (at[std::size_t(face[0])] - origin).dot(areaOf(at, face));
	return sum / 3;
}

double Membrane::area(const std::vector<Vector>& centres) const
{
	const auto at  = nodes(centres);
	double     sum = 0;
	for (const Face& face : faces)
		sum += areaOf(at, face).norm();
	return sum;
}

double Membrane::turned(const std::vector<Vector>& centres, const std::vector<Vector>& normals) const
{
	const auto at  = nodes(centres);
	double     all = 0, inward = 0;
	for (std::size_t f = 0; f < faces.size(); f++) {
		const Vector here = areaOf(at, faces[f]);
		const double size = here.norm();
		all += size;
		if (here.dot(normals[f]) < 0) inward += size;
	}
	return all > 0 ? inward / all : 0;
}

} // namespace yade::ddem
