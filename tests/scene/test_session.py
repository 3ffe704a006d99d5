"""A scene session without a browser: what it accepts, and that it cleans up after itself."""

from __future__ import annotations

import contextlib
import os
import socket
import tempfile
import threading
import time
from pathlib import Path

import msgspec
import numpy as np
import pytest
import viser
from websockets.sync.client import unix_connect

from stairwright.errors import InputError
from stairwright.scene.palette import DARK, LIGHT
from stairwright.scene.session import SceneSession
from tests.scene.example import example_plan, example_rollout, example_terrain


@pytest.fixture
def session():
    session = SceneSession("s")
    yield session
    session.close()


@contextlib.contextmanager
def viewer(session: SceneSession):
    """A browser's end of the scene: it counts once it has told where its camera is."""
    up, nowhere = (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)
    camera = {"wxyz": (1.0, *nowhere), "position": (3.0, 0.0, 1.0), "look_at": nowhere}
    camera |= {"up_direction": up, "fov": 1.0, "near": 0.1, "far": 100.0}
    camera |= {"image_height": 600, "image_width": 800, "type": "ViewerCameraMessage"}
    protocols = [f"viser-v{viser.__version__}"]
    with unix_connect(str(session.address), subprotocols=protocols, max_size=None) as socket:
        socket.send(msgspec.msgpack.encode(camera))
        wait_for(lambda: session.clients == 1)
        yield


@pytest.fixture
def watched(session):
    with viewer(session):
        yield session


@pytest.fixture(scope="module")
def plan():
    return example_plan(count=20).model_dump(mode="json")


def nodes(session: SceneSession) -> set[str]:
    return set(session._server.scene._handle_from_node_name)


def wait_for(check) -> None:
    give_up = time.monotonic() + 20
    while not check() and time.monotonic() < give_up:
        time.sleep(0.01)
    assert check()


def ports() -> int:
    """TCP ports that this process listens on."""
    descriptors = Path("/proc/self/fd")
    ours = {str(each.readlink()) for each in descriptors.iterdir() if each.is_symlink()}
    tables = [
        Path(f"/proc/self/net/{name}").read_text().splitlines()[1:] for name in ("tcp", "tcp6")
    ]
    listening = [line.split() for table in tables for line in table if line.split()[3] == "0A"]
    return sum(f"socket:[{fields[9]}]" in ours for fields in listening)


def test_nobody_else_gets_in():
    before = ports()
    session = SceneSession("s")
    try:
        assert ports() == before
        folder = session.address.parent.stat()
        assert (folder.st_mode & 0o777, folder.st_uid) == (0o700, os.getuid())
        with socket.socket(socket.AF_UNIX) as ours:
            ours.connect(str(session.address))
    finally:
        session.close()


def test_a_scene_that_finds_no_room_says_so_at_once(monkeypatch, tmp_path):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / ("x" * 100)))
    Path(tempfile.gettempdir()).mkdir()
    with pytest.raises(OSError, match="too long"):
        SceneSession("s")
    assert list(Path(tempfile.gettempdir()).iterdir()) == []


def test_shows_terrain_robot_ghosts_paths_and_margins(session, plan):
    session.show(plan=plan)
    wait_for(lambda: "/forces/heads" in nodes(session))  # drawn last
    assert {
        "/terrain/treads",
        "/terrain/edges",
        "/ghosts/trunk",
        "/wheel_path",
        "/com_path",
        "/com/ball",
        "/support/area",
        "/collision_points",
        "/forces/shafts",
    } <= nodes(session)
    assert "/problem/halo" not in nodes(session)


def test_showing_again_reuses_every_node_name(session, plan):
    session.show(plan=plan)
    wait_for(lambda: "/forces/heads" in nodes(session))
    before = nodes(session)
    for count in (12, 30):
        session.show(plan=example_plan(count=count).model_dump(mode="json"), theme="light")
    session.playback(time=1.0)
    wait_for(lambda: nodes(session) == before)


def test_an_infeasible_plan_marks_the_place_and_the_part(session):
    plan = example_plan(count=40, problem=True).model_dump(mode="json")
    session.show(plan=plan)
    session.playback(time=1e6)
    wait_for(lambda: "/forces/heads" in nodes(session))
    assert {"/problem/halo", "/problem/line"} <= nodes(session)
    session.show(plan=example_plan(count=10).model_dump(mode="json"))
    assert "/problem/halo" not in nodes(session)


def test_an_infeasible_plan_without_poses_still_shows_terrain_and_problem(session, plan):
    problem = {"kind": "start", "at": [2.0, 0.1], "progress": 0.0, "message": "no room"}
    nothing = {"poses": [], "critical": [], "status": "infeasible", "problem": problem}
    session.show(plan={**plan, **nothing})
    assert {"/terrain/treads", "/problem/halo"} <= nodes(session)
    assert "/robot/trunk" not in nodes(session)
    assert abs(session._server.initial_camera.look_at[0] - 2.0) < 0.2


def test_nothing_to_show_empties_the_scene(session, plan):
    session.show(plan=plan)
    wait_for(lambda: "/robot/trunk" in nodes(session))
    session.show()
    wait_for(lambda: not nodes(session) & {"/robot/trunk", "/com/ball", "/forces/heads"})
    assert "/terrain/treads" not in nodes(session)
    session.playback(time=1.0, playing=True)


@pytest.mark.usefixtures("watched")
def test_a_rollout_plays_and_its_plan_gives_the_ghosts(session):
    run = example_rollout(example_plan(count=20))
    session.show(rollout=run.model_dump(mode="json"))
    assert session.player.duration == pytest.approx(run.series.time[-1])
    session.playback(time=2.0)
    wait_for(lambda: "/robot/trunk" in nodes(session))
    handle = session._server.scene.get_handle_by_name("/robot/trunk")
    expected = [np.interp(2.0, run.series.time, run.series.base_position[:, k]) for k in range(3)]
    wait_for(lambda: np.allclose(handle.batched_positions[0], expected, atol=1e-4))
    assert "/ghosts/trunk" in nodes(session)


def test_progress_is_a_way_to_say_the_time(session, plan):
    session.show(plan=plan)
    half = plan["poses"][10]
    session.playback(progress=half["progress"])
    assert session.player.time == pytest.approx(half["time"], abs=1e-6)


def test_frames_are_drawn_for_who_looks(session, plan):
    session.show(plan=plan)
    trunk = session._server.scene._handle_from_node_name["/robot/trunk"]
    start = trunk.batched_positions.copy()
    session.playback(time=2.0)
    time.sleep(0.2)
    assert np.array_equal(trunk.batched_positions, start)
    with viewer(session):  # who comes sees the present moment
        wait_for(lambda: not np.array_equal(trunk.batched_positions, start))


def test_layers_hide_and_come_back(session, plan):
    session.show(plan=plan, layers={"ghosts": False, "forces": False})
    by_name = session._server.scene.get_handle_by_name
    hidden = {"/ghosts/trunk", "/forces/heads"}
    # The scene is built on a thread of its own.
    wait_for(lambda: hidden <= set(nodes(session)))
    wait_for(lambda: not any(by_name(name).visible for name in hidden))
    session.set_view(layers={"forces": True})
    assert by_name("/forces/heads").visible
    assert not by_name("/ghosts/trunk").visible
    assert by_name("/terrain/treads").visible


@pytest.mark.parametrize(
    ("call", "field"),
    [
        (lambda s: s.show(theme="sepia"), "theme"),
        (lambda s: s.show(layers={"clouds": True}), "layers.clouds"),
        (lambda s: s.show(layers={"grid": 1}), "layers.grid"),
        (lambda s: s.camera("behind"), "camera"),
        (lambda s: s.playback(speed=0.0), "speed"),
        (lambda s: s.playback(time=float("nan")), "time"),
        (lambda s: s.client_html("scene/x"), "base_path"),
    ],
)
def test_bad_input_says_where(session, call, field):
    with pytest.raises(InputError) as error:
        call(session)
    assert error.value.path == field


def test_friction_tints_the_terrain():
    slippery, usual, grippy = (np.array(DARK.terrain(mu)[0], float) for mu in (0.1, 0.6, 1.2))
    assert slippery[2] - slippery[0] > usual[2] - usual[0] > grippy[2] - grippy[0]
    assert LIGHT.terrain(0.6)[0] == LIGHT.ground


def test_clearance_colours_follow_the_strip():
    found = DARK.clearance_colours(np.array([0.05, 0.012, 0.004, -0.001]))
    assert [tuple(row) for row in found] == list(DARK.strip)


def test_a_weight_slider_asks_for_a_new_plan(plan):
    asked: list[dict[str, float]] = []
    session = SceneSession("s", replan=asked.append)
    try:
        session.show(plan={**plan, "weights": {"clearance": 10.0}})
        sliders = session._panel._weights
        assert set(sliders) == {*example_weights()} - {"aggressiveness"}
        assert sliders["clearance"].value == pytest.approx(1.0)
        for callback in sliders["pitch"]._impl.update_cb:
            callback(type("Event", (), {"client_id": 1}))
        assert asked[0]["clearance"] == pytest.approx(10.0)
    finally:
        session.close()


def example_weights() -> list[str]:
    from stairwright.planning.weights import PathWeights

    return list(PathWeights.model_fields)


def test_closing_frees_socket_and_threads(plan):
    session = SceneSession("s")
    session.show(plan=plan)
    session.close()
    session.close()
    assert not any(t.name == "scene-player" and t.is_alive() for t in threading.enumerate())
    assert not session.address.parent.exists()


def test_a_moved_corner_moves_the_ground_and_the_robot_in_one_batch(session, plan, monkeypatch):
    monkeypatch.setattr(session.player, "set", lambda **_: None)  # no frame of its own follows
    session.show(plan=plan)
    assert "/robot/trunk" in nodes(session)
    sent = []
    server = session._server._websock_server
    queue = server.queue_message
    monkeypatch.setattr(server, "queue_message", lambda m: (sent.append(m), queue(m))[1])
    lower = [[x, 0.9 * z] for x, z in plan["terrain"]["points"]]
    pose = plan["poses"][0]
    poses = [{**pose, "x_c": pose["x_c"] + 0.01}, *plan["poses"][1:]]
    session.show(plan={**plan, "terrain": {**plan["terrain"], "points": lower}, "poses": poses})
    changed = {m.name: set(m.updates) for m in sent if hasattr(m, "updates") and hasattr(m, "name")}
    assert changed["/terrain/treads"] == {"vertices"}
    assert "batched_positions" in changed["/robot/trunk"]
    assert not [m for m in sent if type(m).__name__ == "MeshMessage"]


def test_terrain_with_two_thousand_points_is_drawn(session):
    x = np.linspace(-2, 4, 2000)
    points = [(float(a), float(0.02 * np.sin(9 * a))) for a in x]
    terrain = example_terrain().model_copy(update={"points": points, "name": "waves"})
    plan = example_plan(count=4).model_dump(mode="json")
    session.show(plan={**plan, "terrain": terrain.model_dump(mode="json")})
    session.playback(time=0.5)
    wait_for(lambda: "/robot/trunk" in nodes(session))


@pytest.mark.usefixtures("watched")
def test_a_robot_that_failed_is_red_at_its_end_and_only_there(session):
    rollout = example_rollout().model_dump(mode="json") | {"outcome": "fell"}
    session.show(rollout=rollout)
    wait_for(lambda: "/robot/trunk" in nodes(session))
    trunk = session._server.scene._handle_from_node_name["/robot/trunk"]
    whole, red = (np.array(colour) for colour in (DARK.trunk, DARK.error))
    session.playback(time=rollout["series"]["time"][-1])
    wait_for(lambda: np.array_equal(np.asarray(trunk.batched_colors)[0], red))
    session.playback(time=0.0)
    wait_for(lambda: np.array_equal(np.asarray(trunk.batched_colors)[0], whole))
    session.show(rollout=rollout | {"outcome": "success"})
    session.playback(time=rollout["series"]["time"][-1])
    time.sleep(0.2)
    assert np.array_equal(np.asarray(trunk.batched_colors)[0], whole)


@pytest.mark.usefixtures("watched")
def test_legs_of_the_second_robot_keep_the_colours_of_data(session, plan):
    session.show(plan=plan)
    session.compare(example_plan(count=12).model_dump(mode="json"))
    wait_for(lambda: {"/robot/thighs", "/compare/robot/thighs"} <= set(nodes(session)))
    handles = session._server.scene._handle_from_node_name
    first, second = (np.asarray(handles[f"{root}/thighs"].batched_colors)
                     for root in ("/robot", "/compare/robot"))  # fmt: skip
    assert np.array_equal(first, second)
    trunk = np.asarray(handles["/compare/robot/trunk"].batched_colors)[0]
    assert tuple(trunk) == DARK.com


@pytest.mark.usefixtures("watched")
def test_a_second_plan_is_shown_beside_the_first(session, plan):
    other = example_plan(count=12).model_dump(mode="json")
    session.show(plan=plan)
    session.compare(other)
    wait_for(lambda: "/compare/robot/trunk" in nodes(session))
    assert "/compare/com_path" in nodes(session)
    handle = session._server.scene._handle_from_node_name["/compare/robot/trunk"]
    before = np.array(handle.batched_positions)
    session.playback(progress=plan["poses"][-1]["progress"])
    wait_for(lambda: np.abs(np.array(handle.batched_positions) - before).max() > 0.1)
    session.set_layers({"compare": False})
    assert not handle.visible
    session.set_view(theme="light")
    session.compare(None)
    assert not any(node.startswith("/compare/robot/") for node in nodes(session))
