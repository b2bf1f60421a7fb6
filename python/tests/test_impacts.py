"""Impacts in SI units."""

import csv
import json
import os
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip
from stickslip import Bodies, Material, Motion, Sphere, Surface, Wall, WallMotion, impact

EXAMPLES = Path(__file__).parents[2] / "examples"
STEEL = Material(210e9, 0.3, 7850.0)
SURFACE = Surface(0.4, 1e7)


def spheres() -> Bodies:
    return Bodies(Sphere(0.02, STEEL), Sphere(0.02, STEEL), SURFACE)


def test_scaling() -> None:
    bodies = spheres()
    assert bodies.alpha == pytest.approx(2 / 7, abs=1e-15)
    kappa, psi, damping, unit = bodies.contacts([1.0, 2.0], 0.5)
    assert psi == pytest.approx([0.5 * (2 / 7) / 0.4, 0.25 * (2 / 7) / 0.4], rel=1e-15)
    assert kappa[1] / kappa[0] == pytest.approx(2**-0.4) and damping.tolist() == [0, 0]
    assert unit[1] / unit[0] == pytest.approx(2**-0.2)


def test_impacts_are_collisions() -> None:
    bodies = spheres()
    normal, tangential = np.array([[0.5], [1.0], [2.0]]), np.array([0.1, 0.7])
    found = impact(bodies, normal, tangential)
    kappa, psi, damping, unit = bodies.contacts(normal, tangential)
    assert found.eps_t.shape == (3, 2)
    assert np.array_equal(found.eps_t, stickslip.eps_t(kappa, psi, damping))
    assert np.array_equal(found.tangential_after_m_per_s, found.eps_t * tangential)
    assert np.array_equal(found.contact_time_s, found.collisions.contact_time * unit)
    assert np.array_equal(found.switch_count, found.collisions.switch_count)


def test_speed_and_angle() -> None:
    bodies = spheres()
    angle = np.radians([10.0, 45.0, 80.0])
    found = impact(bodies, speed_m_per_s=2.0, angle_rad=angle)
    assert np.array_equal(found.eps_t, impact(bodies, 2 * np.cos(angle), 2 * np.sin(angle)).eps_t)
    for options, words in [
        ({"speed_m_per_s": 2.0}, "together"),
        ({"speed_m_per_s": 2.0, "angle_rad": 2.0}, "angle_rad = 2.0; expected"),
        ({"speed_m_per_s": 2.0, "angle_rad": 1.0, "normal_m_per_s": 1.0}, "both given"),
        ({"normal_m_per_s": 1.0}, "expected normal_m_per_s and tangential_m_per_s"),
    ]:
        with pytest.raises(ValueError, match=words):
            impact(bodies, **options)


def test_files_of_the_program() -> None:
    laws = {
        "hooke_spheres": "gran/hooke/history",
        "adhesive_spheres": "granular/jkr/viscoelastic/mindlin",
    }
    for path in sorted(EXAMPLES.glob("*.json")):
        law = laws.get(path.stem)
        bodies = Bodies.read(path, law)
        if "velocity_m_per_s" in path.read_text():
            found = bodies.encounter()
            assert found["schema"] == "stickslip.impact/1" and found["switch_count"] >= 0
        alone = impact(path, 1.0, 0.5, law=law)
        assert alone.eps_t == impact(bodies, 1.0, 0.5).eps_t


def program() -> str:
    """The program `stickslip`, from STICKSLIP_PROGRAM or where shells find it."""
    found = os.environ.get("STICKSLIP_PROGRAM") or shutil.which("stickslip")
    if found is None:
        pytest.skip("there is no program stickslip; STICKSLIP_PROGRAM names it")
    return found


@pytest.mark.parametrize(
    ("name", "law"),
    [
        ("steel_pair.json", None),
        ("glass_on_wall.json", None),
        ("hooke_spheres.json", "gran/hooke/history"),
    ],
)
def test_a_batch_of_the_program_is_the_arrays(tmp_path: Path, name: str, law: str | None) -> None:
    normal, tangential = np.meshgrid(np.geomspace(0.01, 3, 9), np.geomspace(0.003, 5, 11))
    pairs = zip(normal.ravel().tolist(), tangential.ravel().tolist(), strict=True)
    lines = [f"{n!r},{t!r}\n" for n, t in pairs]
    (tmp_path / "in.csv").write_text("normal_m_per_s,tangential_m_per_s\n" + "".join(lines))
    command = [program(), "impact", "--batch", "in.csv", "--bodies", str(EXAMPLES / name)]
    command += ["--out", "out.csv", "--method", "auto", *(["--law", law] if law else [])]
    subprocess.run(command, cwd=tmp_path, check=True)
    with (tmp_path / "out.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    found = impact(EXAMPLES / name, normal, tangential, law=law)
    columns = found._columns()
    given = {"normal_m_per_s", "tangential_m_per_s", "status"}
    # What the program writes beside the given columns, bit for bit.
    for column in rows[0].keys() - given - {"kappa", "psi", "damping", "itinerary"}:
        assert [float(row[column]) for row in rows] == columns[column].tolist(), column
    assert [row["itinerary"] for row in rows] == columns["itinerary"].tolist()
    for column in ("kappa", "psi", "damping"):
        expected = getattr(found.collisions, column)
        assert [float(row[column]) for row in rows] == expected.ravel().tolist()


def test_an_array_of_impacts_is_the_encounters() -> None:
    bodies = spheres()
    normal, tangential = np.array([0.5, 2.0]), np.array([0.3, 0.1])
    found = impact(bodies, normal, tangential)
    assert found.velocity_m_per_s.shape == found.spin_rad_per_s.shape == (2, 2, 3)
    for index, (n, t) in enumerate(zip(normal.tolist(), tangential.tolist(), strict=True)):
        one = bodies.encounter(Motion((0, 0, 0.04), (t, 0, -n)), Motion((0, 0, 0), (0, 0, 0)))
        for sphere, motion in enumerate(one["spheres"]):
            assert found.velocity_m_per_s[index, sphere].tolist() == motion["velocity_m_per_s"]
            assert found.spin_rad_per_s[index, sphere].tolist() == motion["spin_rad_per_s"]
        assert found.centre_e_t[index] == one["observed"]["centre_e_t"]
        assert found.impulse_ratio[index] == one["observed"]["impulse_ratio"]
        assert found.kinetic_after_j[index] == one["energy_j"]["kinetic_after"]
    # Momentum and energy.
    momentum = found.velocity_m_per_s.sum(axis=1)
    assert momentum == pytest.approx(np.stack([tangential, 0 * normal, -normal], 1), abs=1e-14)
    assert np.abs(found.unbalanced_j / found.kinetic_before_j).max() < 1e-14


def test_normal_impacts() -> None:
    bodies = Bodies(Sphere(0.02, STEEL), Wall(), Surface(0.4, 1e7, 1e-6))
    found = impact(bodies, [1.0, 1.0], [0.0, 0.5])
    assert found.itinerary.tolist()[0] == "o" and found.switch_count.tolist()[0] == 0
    assert np.isnan(found.eps_t).tolist() == [True, False]
    assert found.eps_n[0] == found.eps_n[1]
    assert found.tangential_after_m_per_s[0] == 0.0 and found.collisions.psi[0] == 0.0
    expected = [0.0, 0.0, found.normal_after_m_per_s[0]]
    assert found.velocity_m_per_s[0, 0] == pytest.approx(expected, rel=1e-15, abs=0.0)
    at_angle = impact(bodies, speed_m_per_s=1.0, angle_rad=[0.0])
    assert at_angle.eps_n[0] == found.eps_n[0] and at_angle.centre_rebound_angle_rad[0] == 0.0


def test_one_bad_impact_does_not_end_an_array() -> None:
    velocities = [1.0, -1.0, float("nan"), 2.0]
    found = impact(spheres(), velocities, 0.5, errors="nan")
    assert np.isnan(found.eps_t).tolist() == [False, True, True, False]
    assert np.isnan(found.kinetic_after_j).tolist() == [False, True, True, False]
    assert sorted(found.failures) == [1, 2] and "normal_m_per_s = -1" in found.failures[1]
    assert found.switch_count.tolist()[1:3] == [-1, -1]
    assert found.eps_t[3] == impact(spheres(), 2.0, 0.5).eps_t


def test_an_encounter_keeps_momentum() -> None:
    first = Motion((0, 0, 0.04), (0.3, 0, -1))
    second = Motion((0, 0, 0), (0, 0, 0), (0, 5, 0))
    found = spheres().encounter(first, second)
    velocities = [np.array(one["velocity_m_per_s"]) for one in found["spheres"]]
    assert sum(velocities) == pytest.approx([0.3, 0, -1], abs=1e-14)
    assert found["eps_n"] == 1.0


def test_walls() -> None:
    wall = Bodies(Sphere(0.02, STEEL), Wall(), SURFACE)
    motions = Motion((0, 0, 0.02), (0.3, 0, -1)), WallMotion((0, 0, 0), (0, 0, 1))
    found = wall.encounter(*motions)
    assert found["spheres"][0]["velocity_m_per_s"][2] == pytest.approx(1, abs=1e-14)
    with pytest.raises(TypeError, match="WallMotion of a wall"):
        wall.encounter(motions[0], motions[0])
    with pytest.raises(ValueError, match="a motion is missing"):
        wall.encounter()
    softer = Bodies(Sphere(0.02, STEEL), Wall(Material(2e9, 0.3)), SURFACE)
    assert softer.contacts(1, 1)[3] > wall.contacts(1, 1)[3]


def bodies_file() -> dict[str, Any]:
    text = (EXAMPLES / "steel_spheres.json").read_text()
    found: dict[str, Any] = json.loads(text)
    return found


def test_bad_files_are_named() -> None:
    def changed(change: Any) -> dict[str, Any]:
        file = bodies_file()
        change(file)
        return file

    def radius(file: dict[str, Any], value: object) -> None:
        file["spheres"][0]["radius_m"] = value

    for change, words in [
        (lambda file: radius(file, -1), "radius_m = -1"),
        (lambda file: radius(file, "big"), r"spheres\[0\].radius_m is 'big'"),
        (lambda file: radius(file, True), r"spheres\[0\].radius_m is True"),
        (lambda file: file.update(colour=1), "colour is not known"),
        (lambda file: file["spheres"].pop(), "spheres has 1 entries, and there is no wall"),
        (lambda file: file.pop("surface"), "surface is missing"),
        (lambda file: file["surface"].update(friction=-1), "friction = -1"),
        (lambda file: file["spheres"][0].update(mass_kg=1), "both given"),
    ]:
        with pytest.raises(ValueError, match=words):
            impact(changed(change), 1.0, 0.5)
    with pytest.raises(ValueError, match=r"\[1\] normal_m_per_s = -1"):
        impact(spheres(), [1.0, -1.0], 0.5)
    with pytest.raises(ValueError, match="contradicts a density"):
        Bodies(Sphere(0.02, STEEL, moment_of_inertia_kg_m2=1e-5), Wall(), SURFACE)
    with pytest.raises(ValueError, match="has no effect"):
        Bodies(Sphere(0.02, STEEL), Wall(STEEL), SURFACE)
