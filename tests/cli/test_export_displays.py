"""`airhilt export` writes a run for displays of other programs, which read it back."""

from __future__ import annotations

import io
import json
import math
import sys
import xml.etree.ElementTree as ET
from collections import defaultdict
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.reader import make_reader
from PIL import Image
from scipy.spatial.transform import Rotation

import airhilt
from airhilt.audio.pcm import to_pcm
from airhilt.errors import AirhiltError
from airhilt.export import export
from airhilt.geodesy.wgs84 import earth_centred
from airhilt.messages import (
    ActorTruth,
    Advisory,
    CameraFrame,
    CameraView,
    Detection,
    Detections,
    Evidence,
    Severity,
)
from airhilt.record.pictures import PictureName
from airhilt.units import DEGREE, SECOND_NS
from radio_folder import TOWER_KHZ, RadioFolder, tone

WIDTH, HEIGHT = 640, 360
COLOUR = (200, 100, 50)
VIEW = CameraView(
    latitude_deg=38.8486, longitude_deg=-77.0425, height_m=60.0, heading_deg=90.0, pitch_deg=0.0,
    roll_deg=0.0, horizontal_fov_deg=60.0, width_px=WIDTH, height_px=HEIGHT,
)  # fmt: skip
BOX = (10.0, 20.0, 30.0, 40.0)
SPOKEN = "AAL123, cleared to land runway 01"
ADVICE = "AAL123, go around."
KML = {"k": "http://www.opengis.net/kml/2.2", "gx": "http://www.google.com/kml/ext/2.2"}


def state(t_s: int) -> ActorTruth:
    """AAL123 on approach, one state a second, nose up and in a bank."""
    return ActorTruth(
        t_ns=t_s * SECOND_NS, actor="AAL123", category="aircraft", phase="approach",
        on_ground=False, latitude_deg=38.82 + 0.0006 * t_s, longitude_deg=-77.03,
        altitude_m=200.0 - 3.0 * t_s, height_agl_m=195.0 - 3.0 * t_s, velocity_north_m_s=67.0,
        velocity_east_m_s=0.0, velocity_down_m_s=3.0, roll_deg=10.0, pitch_deg=4.0,
        heading_deg=30.0,
    )  # fmt: skip


def advisory(name: str, revision: int, t_s: float) -> Advisory:
    """An advisory to AAL123, or its end, revision 1."""
    return Advisory(
        t_ns=round(t_s * SECOND_NS), id=name, revision=revision, recipient="AAL123",
        recipients=("AAL123",), kind="runway_conflict", severity=Severity.WARNING,
        active=revision == 0, traffic=("AAL123", "OPS1"), message=ADVICE,
        evidence=Evidence(sources=("vision",)), t_ready_ns=0,
    )  # fmt: skip


STATES = [state(t_s) for t_s in range(5)]


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> airhilt.Result:
    """A run with an approach, a call, a picture with a detection in it, and an advisory."""
    folder = RadioFolder(tmp_path_factory.mktemp("shown") / "run")
    realised = json.loads(airhilt.load("s01b_dropped_hold").model_dump_json())
    info = folder.folder.info().model_copy(update={"realised": realised})
    folder.folder.write_info(info)
    for each in STATES:
        folder.write("truth/state/AAL123", each)
    folder.call("t1", 1.0, SPOKEN, speaker="AAL123")
    frame = CameraFrame(
        t_ns=2 * SECOND_NS, camera="tower", seq=3, t_frame_ns=2 * SECOND_NS, view=VIEW, sha256=""
    )
    folder.write("camera/tower/frame", frame)
    found = Detections(
        t_ns=3 * SECOND_NS, camera="tower", seq=3, t_frame_ns=2 * SECOND_NS, view=VIEW,
        engine="network", detections=(Detection(label="truck", confidence=0.75, box=BOX),),
    )  # fmt: skip
    folder.write("vision/tower", found)
    folder.write("advisory/AAL123", advisory("simple-1", 0, 3.0))
    folder.write("advisory/AAL123", advisory("simple-1", 1, 4.0))
    folder.folder.pictures_path.mkdir()
    picture = PictureName("first_detection", "tower", 3).path(folder.folder.pictures_path)
    Image.new("RGB", (WIDTH, HEIGHT), COLOUR).save(picture)
    return airhilt.open_run(folder.close())


def time_of_day(text: str) -> float:
    return datetime.fromisoformat(text).timestamp()


def test_a_track_of_kml_has_every_state_at_its_time(run: airhilt.Result, tmp_path: Path) -> None:
    (path,) = export(run, "kml", tmp_path / "kml")
    root = ET.parse(path).getroot()
    (track,) = root.iterfind(".//gx:Track", KML)
    times = [time_of_day(each.text or "") for each in track.iterfind("k:when", KML)]
    assert [at - times[0] for at in times] == [each.t_ns / SECOND_NS for each in STATES]
    places = [(each.text or "").split() for each in track.iterfind("gx:coord", KML)]
    expected = [(one.longitude_deg, one.latitude_deg, one.altitude_m) for one in STATES]
    assert np.allclose(np.array(places, float), expected, atol=1e-2, rtol=0.0)
    angles = [each.text for each in track.iterfind("gx:angles", KML)]
    assert angles == ["30.00 4.00 10.00"] * len(STATES)


def test_words_of_kml_last_as_long_as_they_did(run: airhilt.Result, tmp_path: Path) -> None:
    (path,) = export(run, "kml", tmp_path / "kml")
    root = ET.parse(path).getroot()
    lasted = {
        placemark.findtext("k:name", "", KML): time_of_day(span.findtext("k:end", "", KML))
        - time_of_day(span.findtext("k:begin", "", KML))
        for placemark in root.iterfind(".//k:Placemark", KML)
        if (span := placemark.find("k:TimeSpan", KML)) is not None
    }
    assert lasted == {
        f"AAL123 on 119.100 MHz: {SPOKEN}": 1.0,
        f"WARNING to AAL123: {ADVICE}": 1.0,
    }


def test_a_packet_of_czml_has_places_and_attitudes(run: airhilt.Result, tmp_path: Path) -> None:
    (path,) = export(run, "czml", tmp_path / "czml")
    packets = {packet["id"]: packet for packet in json.loads(path.read_text())}
    actor = packets["AAL123"]
    places = np.reshape(actor["position"]["cartographicDegrees"], (-1, 4))
    assert [tuple(place) for place in places.tolist()] == [
        (one.t_ns / SECOND_NS, one.longitude_deg, one.latitude_deg, one.altitude_m)
        for one in STATES
    ]
    (_, *attitude), *_ = np.reshape(actor["orientation"]["unitQuaternion"], (-1, 5)).tolist()
    ahead = Rotation.from_quat(attitude).apply((0.0, 1.0, 0.0))
    here = STATES[0].latitude_deg * DEGREE, STATES[0].longitude_deg * DEGREE
    north = np.subtract(earth_centred((here[0] + 1e-6, here[1])), earth_centred(here))
    up = np.subtract(earth_centred(here, 1.0), earth_centred(here))
    assert math.degrees(math.asin(ahead @ up)) == pytest.approx(4.0)
    assert ahead @ north / np.linalg.norm(north) == pytest.approx(
        math.cos(math.radians(30.0)) * math.cos(math.radians(4.0))
    )


def test_words_of_czml_stand_at_who_says_or_hears_them(run: airhilt.Result, tmp_path: Path) -> None:
    (path,) = export(run, "czml", tmp_path / "czml")
    packets = json.loads(path.read_text())
    words = [packet for packet in packets if "reference" in packet.get("position", {})]
    assert [(one["label"]["text"], one["position"]["reference"]) for one in words] == [
        (f"AAL123: {SPOKEN}", "AAL123#position"),
        (f"AAL123: {ADVICE}", "AAL123#position"),
    ]
    assert any(packet.get("name") == "runway 01/19" for packet in packets)


def test_advisories_at_one_actor_are_on_different_lines_of_czml(tmp_path: Path) -> None:
    folder = RadioFolder(tmp_path / "run")
    realised = json.loads(airhilt.load("s01b_dropped_hold").model_dump_json())
    folder.folder.write_info(folder.folder.info().model_copy(update={"realised": realised}))
    folder.write("truth/state/AAL123", STATES[0])
    for name, revision, t_s in (
        ("first", 0, 1.0), ("second", 0, 2.0), ("first", 1, 3.0), ("third", 0, 3.0),
        ("second", 1, 4.0), ("third", 1, 4.0),
    ):  # fmt: skip
        folder.write("advisory/AAL123", advisory(name, revision, t_s))
    (path,) = export(airhilt.open_run(folder.close()), "czml", tmp_path / "czml")
    first, second, third = (
        packet["label"]["pixelOffset"]["cartesian2"]
        for packet in json.loads(path.read_text())
        if "reference" in packet.get("position", {})
    )
    assert first == third != second


@pytest.fixture
def foxglove(run: airhilt.Result, tmp_path: Path) -> dict[str, list[tuple[int, Any]]]:
    """Messages of the MCAP by topic, with their times, decoded by its own schemas."""
    pytest.importorskip("foxglove", reason="no foxglove-sdk: pip install airhilt[foxglove]")
    from google.protobuf.descriptor_pb2 import FileDescriptorSet
    from google.protobuf.descriptor_pool import DescriptorPool
    from google.protobuf.message_factory import GetMessageClass

    path, layout = export(run, "foxglove", tmp_path / "foxglove")
    panels = layout.read_text()
    for topic in ("/scene", "/camera/tower/frame", f"/radio/{TOWER_KHZ}/tx", "/log", "AAL123"):
        assert topic in panels
    heard = defaultdict(list)
    with path.open("rb") as stream:
        for schema, channel, message in make_reader(stream).iter_messages():
            assert schema is not None
            pool = DescriptorPool()
            for file in FileDescriptorSet.FromString(schema.data).file:
                pool.AddSerializedFile(file.SerializeToString())
            kind: Any = GetMessageClass(pool.FindMessageTypeByName(schema.name))
            heard[channel.topic].append((message.log_time, kind.FromString(message.data)))
    return heard


@pytest.mark.decoders
def test_foxglove_gets_what_the_run_had_at_its_times(
    foxglove: dict[str, list[tuple[int, Any]]],
) -> None:
    fixes = foxglove["/truth/state/AAL123"]
    assert [(t_ns, fix.latitude, fix.altitude) for t_ns, fix in fixes] == [
        (one.t_ns, one.latitude_deg, one.altitude_m) for one in STATES
    ]
    ((t_ns, sound),) = foxglove[f"/radio/{TOWER_KHZ}/tx"]
    assert (t_ns, sound.data) == (SECOND_NS, to_pcm(tone(1.0)))
    assert {(line.name, line.message) for _, line in foxglove["/log"]} == {
        ("119.100 MHz, as spoken", f"AAL123: {SPOKEN}"),
        ("assistant to AAL123", ADVICE),
        ("assistant to AAL123", f"over: {ADVICE}"),
    }


@pytest.mark.decoders
def test_foxglove_sees_the_picture_with_its_box_through_its_lens(
    foxglove: dict[str, list[tuple[int, Any]]],
) -> None:
    ((_, picture),) = foxglove["/camera/tower/frame"]
    assert Image.open(io.BytesIO(picture.data), formats=["JPEG"]).size == (WIDTH, HEIGHT)
    ((_, annotations),) = foxglove["/vision/tower"]
    assert annotations.timestamp.ToNanoseconds() == picture.timestamp.ToNanoseconds()
    corner = annotations.points[0].points[0]
    assert (corner.x, corner.y) == BOX[:2]
    ((_, calibration),) = foxglove["/camera/tower/calibration"]
    focal = WIDTH / 2.0 / math.tan(math.radians(30.0))
    assert pytest.approx([focal, 0, 320, 0, focal, 180, 0, 0, 1]) == calibration.K


@pytest.mark.decoders
def test_foxglove_places_actors_and_cameras_on_the_airport(
    foxglove: dict[str, list[tuple[int, Any]]],
) -> None:
    moved = defaultdict(list)
    for _, transforms in foxglove["/tf"]:
        for one in transforms.transforms:
            turn = one.rotation
            rotation = Rotation.from_quat((turn.x, turn.y, turn.z, turn.w))
            moved[one.child_frame_id].append((one.translation, rotation))
    assert len(moved["AAL123"]) == len(STATES)
    _, camera = moved["tower"][0]
    assert camera.apply((0.0, 0.0, 1.0)) == pytest.approx((1.0, 0.0, 0.0), abs=1e-9)  # east
    ((_, scene),) = foxglove["/scene"]
    names = [entity.id for entity in scene.entities]
    assert {"AAL123", "OPS1", "OPS2"} <= set(names)
    assert any(name.startswith("protected area") for name in names)
    body = next(entity for entity in scene.entities if entity.id == "AAL123")
    assert (body.frame_id, body.frame_locked) == ("AAL123", True)
    assert len(body.triangles[0].points) == len(body.triangles[0].colors) > 100


@pytest.mark.decoders
def test_rerun_gets_map_scene_pictures_boxes_plots_and_log(
    run: airhilt.Result, tmp_path: Path
) -> None:
    pytest.importorskip("rerun", reason="no rerun-sdk: pip install airhilt[rerun]")
    from rerun.chunk import RrdReader

    (path,) = export(run, "rerun", tmp_path / "rerun")
    reader = RrdReader(path)
    assert len(reader.blueprints()) == 1
    rows: defaultdict[str, int] = defaultdict(int)
    columns: defaultdict[str, set[str]] = defaultdict(set)
    for chunk in reader.stream():
        rows[chunk.entity_path] += chunk.num_rows
        columns[chunk.entity_path] |= set(chunk.to_record_batch().schema.names)
    assert rows["/map/actors/AAL123"] == rows["/world/actors/AAL123"] == len(STATES)
    assert rows["/plots/altitude_m/AAL123"] == len(STATES) + 1  # and its colour
    assert rows["/log"] == 3
    for entity, component in (
        ("/map/actors/AAL123", "GeoPoints:positions"),
        ("/world/actors/AAL123/body", "Mesh3D:vertex_positions"),
        ("/world/cameras/tower", "Pinhole:image_from_camera"),
        ("/world/cameras/tower/picture", "EncodedImage:blob"),
        ("/world/cameras/tower/detections", "Boxes2D:half_sizes"),
        ("/map/airport/runway", "GeoLineStrings:line_strings"),
    ):
        assert component in columns[entity]


@pytest.mark.parametrize(("name", "package"), [("foxglove", "foxglove"), ("rerun", "rerun")])
def test_a_missing_package_is_told_with_the_command_that_installs_it(
    run: airhilt.Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, package: str
) -> None:
    for module in ("airhilt.displays.foxglove_channels", f"airhilt.export.{name}"):
        monkeypatch.delitem(sys.modules, module, raising=False)
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(AirhiltError, match=rf"install it with `pip install 'airhilt\[{name}\]'`"):
        export(run, name, tmp_path / "out")


def test_a_run_of_an_unknown_scenario_cannot_be_shown(tmp_path: Path) -> None:
    run = airhilt.open_run(RadioFolder(tmp_path / "run").close())
    with pytest.raises(AirhiltError, match=r"run.json: its scenario cannot be shown: "):
        export(run, "kml", tmp_path / "out")
    assert not (tmp_path / "out").exists()
