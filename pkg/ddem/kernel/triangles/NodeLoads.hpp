// GPL v2 or later, see LICENSE.
// Forces and dampers on few nodes, such as those of loaded edges.
#pragma once

#include <pkg/ddem/kernel/algebra/PlaneVector.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace yade::ddem {

/// What acts on a node from outside in a step.
struct NodeLoad {
	std::size_t           node;
	PlaneVector<double>   force { 0, 0 };      ///< at the current positions [N]
	InPlaneTensor<double> damper { 0, 0, 0 };  ///< C, positive semi-definite [N·s/m]
	PlaneVector<double>   resistance { 0, 0 }; ///< of the damper in the last step, −C (v⁻ + v⁺)/2 [N]
};

/// Loads by node, in ascending order; each node once.
class NodeLoads {
public:
	/// No load on each of these nodes.
	void assign(std::vector<std::size_t> nodes)
	{
		std::sort(nodes.begin(), nodes.end());
		nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
		load.clear();
		for (const std::size_t node : nodes)
			load.push_back({ node });
	}
	/// Takes forces and dampers away; the nodes stay.
	void clear()
	{
		for (NodeLoad& l : load)
			l = { l.node };
	}
	bool        empty() const { return load.empty(); }
	std::size_t size() const { return load.size(); }
	NodeLoad&   operator[](std::size_t place) { return load[place]; }
	auto        begin() { return load.begin(); }
	auto        begin() const { return load.begin(); }
	auto        end() { return load.end(); }
	auto        end() const { return load.end(); }
	/// Place of the first node that is not below this one.
	std::size_t place(std::size_t node) const
	{
		const auto before = [](const NodeLoad& l, std::size_t value) { return l.node < value; };
		return std::size_t(std::lower_bound(load.begin(), load.end(), node, before) - load.begin());
	}

private:
	std::vector<NodeLoad> load;
};

} // namespace yade::ddem
