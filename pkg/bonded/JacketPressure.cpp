// GPL v2 or later, see LICENSE.
// Pressure of a flexible jacket on spheres, as in a triaxial cell.
#include <pkg/bonded/BondedNewtonIntegrator.hpp>
#include <pkg/bonded/JacketPressure.hpp>
#include <pkg/bonded/ViscousBodyDamping.hpp>

#include <algorithm>
#include <sstream>

namespace yade {

DDEM_PLUGIN((JacketPressure))

namespace {

	std::vector<ddem::Membrane::Face> facesOf(const std::vector<Vector3i>& listed)
	{
		std::vector<ddem::Membrane::Face> faces;
		faces.reserve(listed.size());
		for (const Vector3i& face : listed)
			faces.push_back({ face[0], face[1], face[2] });
		return faces;
	}

} // namespace

void JacketPressure::postLoad(JacketPressure&)
{
	const auto refuse = [](const std::string& what, Real value, const std::string& complaint) {
		std::ostringstream text;
		text << "JacketPressure: " << what << " = " << value << " " << complaint;
		throw std::invalid_argument(text.str());
	};
	if (!(pressure >= 0 && std::isfinite(pressure)))
		refuse("pressure", pressure, "Pa must not be negative: a jacket only pushes");
	if (!(rampTime >= 0 && std::isfinite(rampTime))) refuse("rampTime", rampTime, "s must not be negative");
	if (!(largestTurned >= 0 && largestTurned <= 1))
		refuse("largestTurned", largestTurned, "[-] must be a share, from 0 to 1");
	if (!(axis.norm() > 0) || !axis.allFinite())
		refuse("length of axis", axis.norm(), "[-] must be positive and finite");
	axis.normalize();
	if (lookEvery < 1) refuse("lookEvery", lookEvery, "must be 1 step or more");
	built = false;
}

/// Not in postLoad: attributes come one by one there.
void JacketPressure::build()
{
	if (normals.size() != faces.size())
		throw std::invalid_argument(
		        "JacketPressure has " + std::to_string(faces.size()) + " faces and "
		        + std::to_string(normals.size()) + " normals; each face needs one");
	if (weights.size() != supports.size())
		throw std::invalid_argument(
		        "JacketPressure has " + std::to_string(supports.size()) + " supports and "
		        + std::to_string(weights.size()) + " weights; each support needs one");
	std::vector<ddem::Membrane::Support> shares;
	for (size_t i = 0; i < supports.size(); i++) {
		if (supports[i][1] < 0 || size_t(supports[i][1]) >= ids.size())
			throw std::invalid_argument(
			        "JacketPressure: a node is carried by sphere " + std::to_string(supports[i][1])
			        + ", but there are " + std::to_string(ids.size()) + " ids");
		shares.push_back({ supports[i][0], supports[i][1], weights[i] });
	}
	try {
		membrane = { facesOf(faces), facesOf(ends), shares, offsets };
	} catch (const std::invalid_argument& error) {
		throw std::invalid_argument("JacketPressure: " + std::string(error.what()));
	}
	built = true;
}

Real JacketPressure::pressureAt(Real time) const
{
	const Real since = time - startTime;
	if (!(since >= 0)) return 0;
	return since < rampTime ? 0.5 * (1 - math::cos(Mathr::PI * since / rampTime)) * pressure : pressure;
}

/// Elsewhere its forces would be wiped out, or come a step late.
void JacketPressure::requirePlace() const
{
	const std::string wrong = "wrong order in O.engines: JacketPressure comes ", right = "; put it between";
	bool              here  = false;
	for (const auto& engine : scene->engines) {
		if (engine.get() == this) here = true;
		else if (dynamic_cast<const InteractionLoop*>(engine.get())) {
			if (here)
				throw std::runtime_error(
				        wrong + "before InteractionLoop, which begins the forces of the step anew"
				        + right + " it and NewtonIntegrator");
		} else if (dynamic_cast<const ViscousBodyDamping*>(engine.get())) {
			if (!here)
				throw std::runtime_error(
				        wrong + "after ViscousBodyDamping, which would miss its forces" + right
				        + " InteractionLoop and it");
		} else if (dynamic_cast<const NewtonIntegrator*>(engine.get())) {
			if (!here)
				throw std::runtime_error(
				        wrong + "after NewtonIntegrator, so it has no effect" + right
				        + " InteractionLoop and it");
			return;
		}
	}
	throw std::runtime_error("JacketPressure needs NewtonIntegrator after it in O.engines");
}

/// Of the spheres, from the arrays that move them or from State.
void JacketPressure::readCentres(const BondedSpheres* arrays)
{
	centres.resize(ids.size());
	for (size_t i = 0; i < ids.size(); i++) {
		if (!scene->bodies->exists(ids[i]))
			throw std::runtime_error(
			        "JacketPressure: sphere #" + std::to_string(ids[i])
			        + ", which carries the membrane, is not there any more; keep it, or make the jacket "
			          "anew around the rest");
		if (arrays && arrays->isMovedHere(ids[i])) {
			const double* const x = arrays->motion.poseOf(size_t(arrays->rowOf(ids[i])));
			centres[i]            = { x[0], x[1], x[2] };
		} else
			centres[i] = (*scene->bodies)[ids[i]]->state->pos;
	}
}

/// Adds forces to the spheres.
/// \returns what they have done since the last step, in which leapfrog moved at one speed under the mean of both [J]
Real JacketPressure::addForces(BondedSpheres* arrays)
{
	const bool book = scene->trackEnergy && forces.size() == ids.size(); // none before the first forces
	Real       done = 0;
	for (size_t i = 0; i < ids.size(); i++) {
		Vector3r velocity = Vector3r::Zero();
		if (arrays && arrays->isMovedHere(ids[i])) {
			const auto    row  = size_t(arrays->rowOf(ids[i]));
			double* const load = arrays->motion.loadOf(row);
			for (int k = 0; k < 3; k++)
				load[k] += now[i][k];
			if (!book) continue;
			const double* const v = arrays->motion.velocityOf(row);
			velocity              = { v[0], v[1], v[2] };
		} else {
			scene->forces.addForce(ids[i], now[i]);
			velocity = (*scene->bodies)[ids[i]]->state->vel;
		}
		if (book) done += 0.5 * scene->dt * velocity.dot(forces[i] + now[i]);
	}
	forces.swap(now);
	return done;
}

void JacketPressure::stopIfTurned() const
{
	const Real share = membrane.turned(centres, normals);
	if (share <= largestTurned) return;
	std::ostringstream text;
	text << "JacketPressure: " << share << " of the membrane is inside out in step " << scene->iter
	     << ", t = " << scene->time << " s, more than largestTurned = " << largestTurned
	     << ": the sample beneath it has come apart; end the test earlier, or make the jacket coarser (resolution)";
	throw std::runtime_error(text.str());
}

void JacketPressure::action()
{
	requirePlace();
	if (!built) build();
	if (math::isnan(startTime)) startTime = scene->time;
	const auto* const    newton = BondedNewtonIntegrator::in(*scene);
	BondedSpheres* const arrays = newton ? newton->spheres(*scene) : nullptr;
	readCentres(arrays);
	if (scene->iter % lookEvery == 0) stopIfTurned();
	membrane.forces(centres, pressureAt(scene->time), now);
	now.resize(ids.size(), Vector3r::Zero()); // ids without nodes
	ddem::Membrane::takeMoment(centres, axis, now);
	const Real done = addForces(arrays);
	if (!scene->trackEnergy) return;
	work += done;
	scene->energy->add(-done, "jacketWork", workIx, false);
}

/// For Python, where State is that of now.
void JacketPressure::readState()
{
	scene = Omega::instance().getScene().get();
	if (!built) build();
	readCentres(nullptr);
}

Real JacketPressure::pyVolume()
{
	readState();
	return membrane.volume(centres);
}

Real JacketPressure::pyArea()
{
	readState();
	return membrane.area(centres);
}

Real JacketPressure::pyTurned()
{
	readState();
	return membrane.turned(centres, normals);
}

std::vector<Vector3r> JacketPressure::pyNodes()
{
	readState();
	return membrane.nodes(centres);
}

} // namespace yade
