// GPL v2 or later, see LICENSE.
// Tables of reference values, CSV files with a header line.
#pragma once

#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

/// Rows of a file below tests/data, numbers by column.
inline std::vector<std::map<std::string, double>> referenceTable(const std::string& name)
{
	const std::string path = std::string(DDEM_TEST_DATA) + "/" + name;
	std::ifstream     file(path);
	std::string       line, cell;
	if (!std::getline(file, line)) throw std::runtime_error("cannot read " + path);
	std::vector<std::string> header;
	for (std::istringstream cells(line); std::getline(cells, cell, ',');)
		header.push_back(cell);
	std::vector<std::map<std::string, double>> rows;
	while (std::getline(file, line)) {
		std::istringstream cells(line);
		auto&              row = rows.emplace_back();
		for (const auto& column : header) {
			if (!std::getline(cells, cell, ','))
				throw std::runtime_error(path + ": a row is too short: " + line);
			row[column] = std::stod(cell);
		}
	}
	return rows;
}
