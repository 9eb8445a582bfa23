#!/usr/bin/env python3
"""Writes the bags of this folder with independent writers of ROS 2 bags.

    pip install rosbags mcap mcap-ros2-support
    python3 make_bags.py

The car drives on a circle of the radius 20 m at 5 m/s to the left, from the origin along the x axis:
x = R sin(w t), y = R (1 - cos(w t)), yaw = w t with w = v/R. The steering angle is 0.1 rad and its
command 0.12 rad; stamps begin at 1700000000.5 s.
"""
import math
import shutil
from pathlib import Path

from mcap.writer import CompressionType
from mcap_ros2.writer import Writer as McapWriter
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as BagWriter
from rosbags.typesys import Stores, get_typestore

R, V, RATE, COUNT = 20.0, 5.0, 10, 21
W = V / R
START = 1_700_000_000_500_000_000
HERE = Path(__file__).resolve().parent

TIME = "================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
HEADER = "================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" + TIME


def part(name, text):
    return f"{'=' * 80}\nMSG: {name}\n{text}"


POSE = (part("geometry_msgs/Pose", "Point position\nQuaternion orientation\n")
        + part("geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n")
        + part("geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"))
TWIST = (part("geometry_msgs/Twist", "Vector3 linear\nVector3 angular\n")
         + part("geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"))
ODOMETRY = ("# Pose and velocity\nstd_msgs/Header header\nstring child_frame_id\n"
            "geometry_msgs/PoseWithCovariance pose\ngeometry_msgs/TwistWithCovariance twist\n" + HEADER + POSE + TWIST
            + part("geometry_msgs/PoseWithCovariance", "Pose pose\nfloat64[36] covariance\n")
            + part("geometry_msgs/TwistWithCovariance", "Twist twist\nfloat64[36] covariance\n"))
ACKERMANN = ("std_msgs/Header header\nAckermannDrive drive\n" + HEADER
             + part("ackermann_msgs/AckermannDrive", "float32 steering_angle\nfloat32 steering_angle_velocity\n"
                    "float32 speed\nfloat32 acceleration\nfloat32 jerk\n"))
POSE_STAMPED = "std_msgs/Header header\ngeometry_msgs/Pose pose\n" + HEADER + POSE
PATH = ("std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n" + HEADER + POSE
        + part("geometry_msgs/PoseStamped", "std_msgs/Header header\nPose pose\n"))
STEERING = "builtin_interfaces/Time stamp\nfloat32 steering_tire_angle\n" + TIME
VELOCITY = ("std_msgs/Header header\nfloat32 longitudinal_velocity\nfloat32 lateral_velocity\nfloat32 heading_rate\n"
            + HEADER)
CONTROL = ("builtin_interfaces/Time stamp\nbuiltin_interfaces/Time control_time\nLateral lateral\nLongitudinal longitudinal\n"
           + TIME
           + part("autoware_control_msgs/Lateral", "builtin_interfaces/Time stamp\nbuiltin_interfaces/Time control_time\n"
                  "float32 steering_tire_angle\nfloat32 steering_tire_rotation_rate\n"
                  "bool is_defined_steering_tire_rotation_rate\n")
           + part("autoware_control_msgs/Longitudinal", "builtin_interfaces/Time stamp\nbuiltin_interfaces/Time control_time\n"
                  "float32 velocity\nfloat32 acceleration\nfloat32 jerk\nbool is_defined_acceleration\n"
                  "bool is_defined_jerk\n"))


def stamp(ns):
    return {"sec": ns // 10**9, "nanosec": ns % 10**9}


def header(ns):
    return {"stamp": stamp(ns), "frame_id": "map"}


def pose(t):
    return {"position": {"x": R * math.sin(W * t), "y": R * (1 - math.cos(W * t)), "z": 0.0},
            "orientation": {"x": 0.0, "y": 0.0, "z": math.sin(W * t / 2), "w": math.cos(W * t / 2)}}


def twist():
    return {"linear": {"x": V, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": W}}


def times():
    return [(i / RATE, START + i * 10**9 // RATE) for i in range(COUNT)]


def write_mcap(file, compression, topics):
    with open(file, "wb") as out:
        writer = McapWriter(out, chunk_size=4096, compression=compression)
        for topic, (kind, definition, message) in topics.items():
            schema = writer.register_msgdef(kind, definition)
            for t, ns in times():
                made = message(t, ns)
                if made is not None:
                    writer.write_message(topic, schema, made, log_time=ns + 1000, publish_time=ns + 1000)
        writer.finish()


def path(t, ns):
    if t > 0:
        return None
    return {"header": header(ns), "poses": [{"header": header(ns), "pose": pose(0.2 * i)} for i in range(12)]}


write_mcap(HERE / "odometry.mcap", CompressionType.ZSTD, {
    "/odom": ("nav_msgs/msg/Odometry", ODOMETRY, lambda t, ns: {
        "header": header(ns), "child_frame_id": "base_link",
        "pose": {"pose": pose(t), "covariance": [0.0] * 36},
        "twist": {"twist": twist(), "covariance": [0.0] * 36}}),
    "/drive": ("ackermann_msgs/msg/AckermannDriveStamped", ACKERMANN, lambda t, ns: {
        "header": header(ns), "drive": {"steering_angle": 0.12, "steering_angle_velocity": 0.0, "speed": V,
                                        "acceleration": 0.0, "jerk": 0.0}}),
    "/plan": ("nav_msgs/msg/Path", PATH, path)})
write_mcap(HERE / "autoware.mcap", CompressionType.LZ4, {
    "/localization/pose": ("geometry_msgs/msg/PoseStamped", POSE_STAMPED,
                           lambda t, ns: {"header": header(ns), "pose": pose(t)}),
    "/vehicle/status/velocity_status": ("autoware_vehicle_msgs/msg/VelocityReport", VELOCITY, lambda t, ns: {
        "header": header(ns), "longitudinal_velocity": V, "lateral_velocity": 0.0, "heading_rate": W}),
    "/vehicle/status/steering_status": ("autoware_vehicle_msgs/msg/SteeringReport", STEERING, lambda t, ns: {
        "stamp": stamp(ns), "steering_tire_angle": 0.1}),
    "/control/command/control_cmd": ("autoware_control_msgs/msg/Control", CONTROL, lambda t, ns: {
        "stamp": stamp(ns), "control_time": stamp(ns),
        "lateral": {"stamp": stamp(ns), "control_time": stamp(ns), "steering_tire_angle": 0.12,
                    "steering_tire_rotation_rate": 0.0, "is_defined_steering_tire_rotation_rate": True},
        "longitudinal": {"stamp": stamp(ns), "control_time": stamp(ns), "velocity": V, "acceleration": 0.25, "jerk": 0.0,
                         "is_defined_acceleration": True, "is_defined_jerk": False}})})


def write_bag(name, plugin, mode=None):
    folder = HERE / name
    shutil.rmtree(folder, ignore_errors=True)
    store = get_typestore(Stores.ROS2_HUMBLE)
    types = store.types
    made_header = lambda ns: types["std_msgs/msg/Header"](
        types["builtin_interfaces/msg/Time"](ns // 10**9, ns % 10**9), "map")
    vector = lambda x, y, z: types["geometry_msgs/msg/Vector3"](x, y, z)
    writer = BagWriter(folder, version=8, storage_plugin=plugin)
    if mode is not None:
        writer.set_compression(mode, CompressionFormat.ZSTD)
    with writer:
        poses = writer.add_connection("/pose", "geometry_msgs/msg/PoseStamped", typestore=store)
        twists = writer.add_connection("/twist", "geometry_msgs/msg/TwistStamped", typestore=store)
        for t, ns in times():
            own = pose(t)
            message = types["geometry_msgs/msg/PoseStamped"](made_header(ns), types["geometry_msgs/msg/Pose"](
                types["geometry_msgs/msg/Point"](**own["position"]),
                types["geometry_msgs/msg/Quaternion"](**own["orientation"])))
            writer.write(poses, ns + 1000, store.serialize_cdr(message, message.__msgtype__))
            message = types["geometry_msgs/msg/TwistStamped"](made_header(ns), types["geometry_msgs/msg/Twist"](
                vector(V, 0.0, 0.0), vector(0.0, 0.0, W)))
            writer.write(twists, ns + 1000, store.serialize_cdr(message, message.__msgtype__))


write_bag("sqlite", StoragePlugin.SQLITE3)
write_bag("sqlite_zstd", StoragePlugin.SQLITE3, CompressionMode.MESSAGE)
write_bag("mcap", StoragePlugin.MCAP)
