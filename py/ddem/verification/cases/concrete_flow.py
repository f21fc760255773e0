# GPL v2 or later, see LICENSE.
"""Viscoplastic flow of concrete at a point: strength of the law without damage, in closed form,
and what damage makes of it."""
import numpy as np

from yade.ddem import plots
from yade.ddem.materialpoint import MaterialPoint, concrete
from yade.ddem.verification import case, concrete_rates, concrete_theory, tools

FLOW = {"viscoplasticFlow", "rateDependence"}  #: effects of the flow alone


def plateau(parameters, rate, confinement=0.0):
	"""Axial stress of a point without damage that has flowed to 3 % [Pa]."""
	end = MaterialPoint(parameters, effects=FLOW).uniaxial(
		rate=rate, until=np.copysign(0.03, rate), confinement=confinement, step=1e-6, every=30_000
	)
	return end.axial_stress[-1]


@case(group="concrete at a point", seconds=0.5)
def steady_flow(check):
	"""Steady flow without damage

	Strained for long, a point without damage flows at a constant stress. All strain is then that of the flow,
	ε̇ = ½ M_p ė_eq, and eq. 7 can be solved for the stress:

		σ_eq = σ_p0 (ė_eq/(Λ_0 ė_0 (ė_N/ė_0)^ω_p))^(1/n_p),   ė_N = ė_eq √(M_p:M_p/8)

	In tension it grows by the power (1 − ω_p)/n_p = 0.08 of the rate; under pressure friction decays, and the
	stress is the root of an equation in one unknown.

	Reference: Zubelewicz (2018), eqs. 5–7, with the closures for ė_N and q_D that ConcreteDamageMat names.

	Expect: the law, which takes the friction of the predictor, is first order in the step: 10⁻³ at 10⁻⁵ of strain,
	1.4·10⁻⁴ at 10⁻⁶, which is taken here. In tension friction is constant, and only the relaxation to
	the steady state is left.
	"""
	parameters = concrete()
	up, down = np.array((0, 1, 0)), np.array((0, -1, 0))
	tests = [("tension", rate, 0, up) for rate in (1e-3, 1, 1e3)] + [
		("compression", -rate, 0, down) for rate in (1e-3, 1, 1e3)
	]
	tests += [("compression", -1, pressure, down) for pressure in (20e6, 40e6, 60e6)]
	for name, rate, confinement, direction in tests:
		expected = concrete_theory.steady_stress(parameters, direction, 1, rate, confinement)[1]
		what = f"{name} at {abs(rate):g} /s" + (
			f", confined by {confinement / 1e6:g} MPa" if confinement else ""
		)
		check(
			f"{what} [Pa]",
			plateau(parameters, rate, confinement),
			expected,
			1e-8 if rate > 0 else 3e-4,
			"steady flow in closed form",
		)
	slow, fast = (plateau(parameters, rate) for rate in (1e-3, 1e3))
	check(
		"power of the rate in tension [-]",
		np.log10(fast / slow) / 6,
		(1 - parameters["rateExponent"]) / parameters["flowExponent"],
		1e-6,
		"(1 − ω_p)/n_p",
	)
	rates = np.logspace(-6, 3, 10)
	found = {sign: np.array([abs(plateau(parameters, sign * rate)) for rate in rates]) for sign in (-1, 1)}

	def draw():
		fig, (ax,) = tools.axes(height=58)
		for sign, name, marker in ((-1, "compression", "o"), (1, "tension", "s")):
			exact = [
				abs(concrete_theory.steady_stress(parameters, (0, sign, 0), 1, sign * r)[1])
				for r in rates
			]
			ax.loglog(rates, found[sign] / 1e6, marker, markersize=3, label=name)
			ax.loglog(
				rates, np.array(exact) / 1e6, "k-", linewidth=0.7,
				label="closed form" if sign > 0 else None
			)
		ax.set_xlabel("strain rate [1/s]")
		ax.set_ylabel("stress of steady flow [MPa]")
		tools.legend(ax, 3)
		return fig

	check.picture(
		draw, "Uniaxial stress at which a point without damage flows steadily, over nine decades of the rate."
	)


@case(group="concrete at a point", seconds=0.3)
def damage_growth(check):
	"""Damage grows with the work of flow

	The work of the flow is w = ∫ σ:ε̇_p dt = ∫ σ_eq ė_eq dt. With constant friction the directions of flow do not
	change in a uniaxial test, and eq. 8 says

		Ω = ½ M_c ξ_c0 w/G_f

	with ξ_c0 = 1 in an open crack and 0.5 in a closed one. The book of energies closes:
	stored + plastic + damage = work of the stress.

	Reference: Zubelewicz (2018), eqs. 6 and 8; the second law.

	Expect: 10⁻⁴ for the damage with steps of 10⁻⁶ (what is booked is the mean of two steps, what damages is the
	second); the energies to round-off.
	"""
	parameters = concrete(frictionPressureExponent=0)
	drawn = {}
	for name, sign, growth in (("tension", 1, 1.0), ("compression", -1, parameters["closedGrowth"])):
		result = MaterialPoint(parameters).uniaxial(rate=sign, until=sign * 0.02, step=1e-6)
		_, complementary = concrete_theory.flow_tensors(parameters, (0, sign, 0))
		# a closed crack grows at half the rate once it is one: σ_Ω < 0 needs damage first,
		# so compare what comes after
		first = 2000
		work = np.diff(result.plastic_dissipation[[first, -1]])[0]
		grown = result.damage[-1] - result.damage[first]
		for axis, part in ((0, "across"), (1, "along")):
			expected = 0.5 * complementary[axis] * growth * work / parameters["fractureEnergy"]
			check(f"damage {part} in {name} [-]", grown[axis], expected, 1e-4, "Zubelewicz (2018), eq. 8")
		stress, strain = result.stress, result.strain
		done = (0.5 * (stress[1:] + stress[:-1]) * np.diff(strain, axis=0) * [1, 1, 1, 2]).sum()
		kept = result.stored_energy + result.plastic_dissipation + result.damage_dissipation
		check(f"energy found over the work in {name} [-]", (kept[-1] - kept[0]) / done, 1, 1e-10, "first law")
		losses = np.concatenate([np.diff(result.plastic_dissipation), np.diff(result.damage_dissipation)])
		lowest = min(losses.min() / losses.max(), 0)
		check(
			f"smallest dissipation of a step over the largest in {name} [-]",
			lowest, 0, 1e-12, "second law: never negative", scale=1
		)
		drawn[name] = (
			np.abs(result.axial_strain),
			result.stored_energy,
			result.plastic_dissipation,
			result.damage_dissipation,
		)

	def draw():
		fig, panels = tools.axes(plots.PAGE, 58, panels=2)
		for ax, (name, (strain, *parts)) in zip(panels, drawn.items()):
			labels, colours = ("stored", "plastic flow", "damage"), [plots.COLOURS[i] for i in (5, 4, 1)]
			ax.stackplot(100 * strain, *(part / 1e3 for part in parts), labels=labels, colors=colours)
			ax.axhline(
				parameters["fractureEnergy"] / 1e3, color="k", linewidth=0.6, linestyle="--",
				label="$G_f$"
			)
			ax.set_title(name)
			ax.set_xlabel("strain [%]")
			ax.set_ylabel("energy [kJ/m³]")
		panels[0].legend(loc="upper left")
		return fig

	check.picture(draw, "Energy per volume in uniaxial tension and compression at 1/s, constant friction.")
	check.note(
		"G_f is a scale, not the area below the curve: half of the strength is gone when the flow has done "
		"the work 2 G_f/|M_c| in an open crack, and the work goes on growing, slower and slower."
	)


# σ_x/σ_y in compression and in tension
RATIOS = {-1: (0, 0.2, 0.4, 0.6, 0.8, 1, -0.05, -0.1, -0.2, -0.5), 1: (0, 0.3, 0.6, 1, -0.5, -0.99)}
# those that are integrated as rate equations as well
INTEGRATED = ((0.2, -1), (0.6, -1), (-0.1, -1), (0.3, 1), (-0.5, 1))


@case(group="concrete at a point", seconds=3)
def strength_envelope(check, step=1e-5):
	"""Strength under two and three stresses

	Left: plane stress, both stresses growing in proportion, the larger of them strained at 1/s; right: confined
	compression. Lines are the closed form of steady flow without damage; circles are the peaks of the whole law,
	which damage keeps below it.

	Reference: steady flow in closed form, Zubelewicz (2018), eqs. 5–7; for the peaks the rate equations, integrated
	by SciPy. Beside them, for the eye: biaxial compression, (1 + 3.65 a)/(1 + a)² f_c at the ratio a of the
	stresses (Kupfer and Gerstle 1973, fitted to the tests of Kupfer, Hilsdorf and Rüsch 1969, where equal stresses
	bear 1.16 f_c), and confined cylinders, f_c + 4.1 p (Richart, Brandtzaeg and Brown 1928).

	Expect: without damage within 0.3 % of the closed form everywhere, peaks within 0.2 %,
	both first order in the steps of 10⁻⁵.
	"""
	parameters = concrete()
	peaks, largest = {}, 0.0
	for sign, ratios in RATIOS.items():
		for ratio in ratios:
			steady, _ = proportional(parameters, ratio, sign, FLOW, step)
			expected = concrete_theory.steady_stress(parameters, (ratio * sign, sign, 0), 1, sign)[1]
			largest = max(largest, abs(steady / expected - 1))
			_, peaks[ratio, sign] = proportional(parameters, ratio, sign, None, step)
	check(
		f"plane stress without damage, {len(peaks)} directions: largest relative difference [-]",
		largest, 0, 3e-3, "steady flow in closed form", scale=1
	)
	for ratio, sign in INTEGRATED:
		strain, stress, _, _ = concrete_rates.RatePoint(parameters).go(
			0.003, {"yy": sign * 0.003}, {"zz": 0.0}, {"xx": ("yy", ratio)},
			shares=concrete_rates.fractions(150)
		)
		expected = concrete_rates.peak(strain[:, 1], stress[:, 1])
		check(
			f"peak in plane stress, σ_x = {ratio:g} σ_y, {name_of(sign > 0)} [Pa]",
			peaks[ratio, sign][1], expected, 2e-3, concrete_rates.SOURCE
		)
	uniaxial, biaxial = -peaks[0, -1][1], -peaks[1, -1][1]
	confinements = np.linspace(0, 100e6, 6)
	confined = np.array(
		[
			-MaterialPoint(parameters).uniaxial(rate=-1, until=-0.007, confinement=c, every=10).peak.stress
			for c in confinements
		]
	)

	def draw():
		fig, (left, right) = tools.axes(plots.PAGE, 88, panels=2)
		# equal stresses, where the line turns sharply
		near = np.add.outer((-135, -90, 0, 45), np.linspace(-4, 4, 41)).ravel()
		angles = np.radians(np.unique(np.clip(np.concatenate([np.linspace(-135, 45, 91), near]), -135, 45)))
		both_sides = lambda half: np.vstack([half, half[::-1, ::-1]]).T / 1e6
		left.plot(
			*both_sides(np.array([envelope_point(parameters, angle) for angle in angles])),
			"k-",
			linewidth=0.7,
			label="steady flow, closed form",
		)
		left.plot(
			*both_sides(np.array(list(peaks.values()))), "o", color=plots.COLOURS[0], markersize=3,
			label="peak of the law"
		)
		ratio = np.linspace(0, 1, 50)
		left.plot(
			*both_sides(
				-uniaxial
				* concrete_theory.kupfer(ratio)[:, None]
				* np.column_stack([ratio, np.ones(50)])
			),
			"--", color=plots.COLOURS[1], linewidth=0.8,
			label="tests (Kupfer and Gerstle 1973)"
		)
		left.set_aspect("equal")
		left.set_xlabel(r"$\sigma_1$ [MPa]")
		left.set_ylabel(r"$\sigma_2$ [MPa]")
		tools.legend(left, 1)
		axis = np.linspace(0, 100e6, 60)
		exact = [-concrete_theory.steady_stress(parameters, (0, -1, 0), 1, -1, c)[1] for c in axis]
		right.plot(axis / 1e6, np.array(exact) / 1e6, "k-", linewidth=0.7, label="steady flow, closed form")
		right.plot(
			confinements / 1e6, confined / 1e6, "o", color=plots.COLOURS[0], markersize=3,
			label="peak of the law"
		)
		tested = concrete_theory.richart(uniaxial, axis) / 1e6
		right.plot(
			axis / 1e6, tested, "--", color=plots.COLOURS[1], linewidth=0.8,
			label="tests (Richart et al. 1928)"
		)
		right.set_ylim(0, None)
		right.set_xlabel("confining pressure $p$ [MPa]")
		right.set_ylabel("axial strength [MPa]")
		tools.legend(right, 1)
		return fig

	check.picture(
		draw,
		"Strength at 1/s under plane stress (left) and confined compression (right); lines of tests scaled to "
		"the uniaxial strength of the law.",
	)
	check.note(
		f"A limit of the law: {uniaxial / 1e6:.0f} MPa belong to stress states with two equal lateral "
		"stresses only. There the two share the flow, M_p:M_p is smaller, ė_N with it, and by its power "
		"ω_p/n_p = 1.92 the stress is larger by 1.9. A lateral stress of a few per cent brings the strength "
		f"down to {-peaks[0.2, -1][1] / 1e6:.0f} MPa, which is also that in plane strain; in equal biaxial "
		f"compression it is {biaxial / 1e6:.0f} MPa, {biaxial / uniaxial:.2f} of the uniaxial strength, where "
		"tests have 1.16. The report compares with uniaxial tests only, and does not say how equal stresses "
		"share the flow."
	)


def proportional(parameters, ratio, sign, effects, step):
	"""Final stress σ_y [Pa] and (σ_x, σ_y) at the peak of a point under σ_x = ratio·σ_y, σ_z = 0, strained along
	y at 1/s to 0.6 %, or until it has softened by a tenth; σ_x follows σ_y a step behind,
	except where both are equal by symmetry."""
	point, stresses, peak = MaterialPoint(parameters, effects=effects), [(0.0, 0.0)], (0.0, 0.0)
	for strain in sign * np.arange(step, 0.006, step):
		lateral = (
			{"strain": {"xx": strain}, "stress": {}}
			if ratio == 1
			else {"strain": {}, "stress": {"xx": ratio * stresses[-1][1]}}
		)
		end = point.path(
			step,
			strain={"yy": strain, **lateral["strain"]},
			stress={"zz": 0.0, **lateral["stress"]},
			steps=1,
		)
		stresses.append(tuple(end.stress[-1, :2]))
		peak = max(peak, stresses[-1], key=lambda stress: abs(stress[1]))
		if abs(stresses[-1][1]) < 0.9 * abs(peak[1]):
			break
	return stresses[-1][1], np.array(peak)


def envelope_point(parameters, angle):
	"""(σ_1, σ_2) [Pa] of steady flow in a direction of the plane of stresses, the larger stress strained at 1/s."""
	direction = np.array((np.cos(angle), np.sin(angle), 0.0))
	axis = int(np.argmax(np.abs(direction)))
	return concrete_theory.steady_stress(parameters, direction, axis, np.sign(direction[axis]))[:2]


@case(group="concrete at a point", seconds=2)
def rate_factors(check):
	"""Strength and strain rate, beside Model Code 2010

	Peaks of the whole law over the strain rate, in uniaxial tension and compression, each over the peak at the rate
	that the code calls static.

	Reference: the rate equations, integrated by SciPy. Beside them, for the eye and in the note, as the law is not
	made for it: fib Model Code for Concrete Structures 2010 (2013), clause 5.1.11.2: (ε̇/30·10⁻⁶)^0.014, above
	30 /s 0.012 (ε̇/30·10⁻⁶)^⅓ in compression; (ε̇/10⁻⁶)^0.018, above 10 /s 0.0062 (ε̇/10⁻⁶)^⅓ in tension;
	up to 300 /s.

	Expect: factors within 5·10⁻⁴ of the rate equations, and far above the code at moderate rates.
	"""
	parameters = concrete()
	rates = {
		tension: np.concatenate([[static], (decades := np.logspace(-5, 3, 17))[decades > static]])
		for tension, static in concrete_theory.FIB_STATIC.items()
	}
	factors = {}
	for tension, until in ((False, -0.004), (True, 0.0025)):
		signed = lambda rate: np.copysign(rate, until)
		peaks = np.array(
			[
				abs(MaterialPoint(parameters).uniaxial(signed(rate), until).peak.stress)
				for rate in rates[tension]
			]
		)
		factors[tension] = peaks / peaks[0]

		def integrated(rate):
			strain, stress = concrete_rates.RatePoint(parameters).uniaxial(signed(rate), until)
			return concrete_rates.peak(strain[:, 1], stress[:, 1])

		static = integrated(rates[tension][0])
		for rate in (1, 1e3):
			found = factors[tension][np.isclose(rates[tension], rate)][0]
			check(
				f"factor in {name_of(tension)} at {rate:g} /s [-]", found, integrated(rate) / static,
				5e-4, concrete_rates.SOURCE
			)

	def draw():
		fig, panels = tools.axes(plots.PAGE, 58, panels=2, sharex=True, sharey=True)
		for ax, tension in zip(panels, (False, True)):
			ax.semilogx(rates[tension], factors[tension], "o", markersize=3, label="peak of the law")
			shown = np.geomspace(concrete_theory.FIB_STATIC[tension], 300, 300)
			ax.semilogx(
				shown, concrete_theory.fib_factor(shown, tension), "k-", linewidth=0.8,
				label="fib Model Code 2010"
			)
			ax.set_title(name_of(tension))
			ax.set_xlabel("strain rate [1/s]")
		panels[0].set_ylabel("strength / static strength [-]")
		panels[0].legend(loc="upper left")
		return fig

	check.picture(
		draw,
		"Strength over strain rate, over the strength at the static rate of the code: 30·10⁻⁶ /s in "
		"compression, 10⁻⁶ /s in tension.",
	)
	at = lambda tension, rate: factors[tension][np.isclose(rates[tension], rate)][0]
	check.note(
		"Factors of the law and of the code: "
		+ ", ".join(
			(
				f"{name_of(tension)} at {rate:g} /s {at(tension, rate):.2f} and "
				f"{float(concrete_theory.fib_factor(rate, tension)):.2f}"
			)
			for tension in (False, True)
			for rate in (1, 10, 100)
		)
		+ (
			f". From the static rate to 1/s the law grows as the power {power(at(False, 1), 30e-6):.3f} "
			f"of the rate in compression and {power(at(True, 1), 1e-6):.3f} in tension, the code as "
			"0.014 and 0.018 up to 30 and 10 /s, and ⅓ above."
		)
	)


def name_of(tension):
	return "tension" if tension else "compression"


def power(factor, static):
	"""Power of the rate by which strength grows by a factor from the static rate [1/s] to 1/s."""
	return -np.log(factor) / np.log(static)
