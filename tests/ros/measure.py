#!/usr/bin/python3
"""Robots on one master, and a robot and a computer with a radio link between them.

  /usr/bin/python3 tests/ros/measure.py BUILD robots [N]   N simulated robots (5), everything on this machine
  /usr/bin/python3 tests/ros/measure.py BUILD sizes        a robot with pictures of two sizes, raw and compressed
  /usr/bin/python3 tests/ros/measure.py BUILD splits       each split over the link, as root; the robot drives line A

BUILD is the build of apps/ros (build/release/ros). The link of `splits` is two network namespaces joined by a
relay: 20 ms of delay each way, 20 Mbit/s, 1 % of the packets lost. Prints rows of Markdown.
"""
import fcntl
import heapq
import math
import os
import random
import select
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time

HERE = os.path.dirname(os.path.abspath(__file__))
DATA = os.path.join(HERE, "..", "..", "data")
SIZE = "800x600"
LAMPS = DATA + "/lamps/paper.yaml"
SETTLED, SECONDS = 15, 20  # s, from the nodes' start to what is measured, and its length
LINE_END = 0.35, -0.005  # m, of data/paths/line-a.yaml


class Link:
    """Joins two network namespaces, each with an interface of its own."""

    ADDRESSES = {"vlp-robot": "10.97.0.1", "vlp-pc": "10.97.0.2"}

    def __init__(self, delay=0.02, rate=20e6, loss=0.01, backlog=0.3):
        self.delay, self.rate, self.loss, self.backlog = delay, rate, loss, backlog
        self.sent = {}  # bytes, by the namespace that they came from
        self.files = {}
        for name, address in self.ADDRESSES.items():
            file = os.open("/dev/net/tun", os.O_RDWR)
            fcntl.ioctl(file, 0x400454CA, struct.pack("16sH22x", name.encode(), 0x1001))  # TUNSETIFF: tun, no header
            self.files[name] = file
            self.sent[name] = 0
            other = [a for a in self.ADDRESSES.values() if a != address][0]
            for command in (
                f"ip netns add {name}",
                f"ip link set {name} netns {name}",
                f"ip netns exec {name} ip link set lo up",
                f"ip netns exec {name} ip addr add {address} peer {other} dev {name}",
                f"ip netns exec {name} ip link set {name} up",
            ):
                subprocess.run(command.split(), check=True)
        self.stopped = False
        self.thread = threading.Thread(target=self.relay)
        self.thread.start()

    def relay(self):
        chance = random.Random(1)
        names = list(self.files)
        free = dict.fromkeys(names, 0.0)  # s, when the line from there has sent all it was given
        waiting = []  # time, number, file, packet
        number = 0
        while not self.stopped:
            pause = max(0, min(0.05, waiting[0][0] - time.monotonic())) if waiting else 0.05
            for file in select.select(list(self.files.values()), [], [], pause)[0]:
                packet = os.read(file, 2048)
                here = [name for name in names if self.files[name] == file][0]
                there = [name for name in names if name != here][0]
                self.sent[here] += len(packet)
                now = time.monotonic()
                start = max(now, free[here])
                if start - now > self.backlog or chance.random() < self.loss:
                    continue
                free[here] = start + 8 * len(packet) / self.rate
                number += 1
                heapq.heappush(waiting, (free[here] + self.delay, number, self.files[there], packet))
            while waiting and waiting[0][0] <= time.monotonic():
                _, _, file, packet = heapq.heappop(waiting)
                os.write(file, packet)

    def close(self):
        self.stopped = True
        self.thread.join()
        for name, file in self.files.items():
            os.close(file)
            subprocess.run(["ip", "netns", "del", name], check=False)


class Nodes:
    """Processes; each is killed in the end."""

    def __init__(self, build):
        self.bin = os.path.join(build, "devel/lib/visp_vlp")
        self.all = []
        self.logs = tempfile.TemporaryDirectory()

    def start(self, name, arguments, host=None, master="127.0.0.1", program=None):
        environment = dict(os.environ, PATH="/usr/bin:" + os.environ["PATH"], ROS_MASTER_URI=f"http://{master}:11397",
                           ROS_IP=Link.ADDRESSES.get(host, "127.0.0.1"), ROS_LOG_DIR=self.logs.name)
        prefix = ["ip", "netns", "exec", host] if host else []
        process = subprocess.Popen(prefix + [program or os.path.join(self.bin, name)] + arguments, env=environment,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        self.all.append((name, process))
        return process

    def robot(self, robot, where, master="127.0.0.1", transport="raw", x=-0.35, y=0.0, size=SIZE, quality=0):
        """where: the network namespace of each node, None for this machine's. quality: of JPEG; 0 for PNG."""
        own = [f"__ns:=/{robot}", f"_rig:={DATA}/rigs/ub300-{size}.yaml", f"_lamps:={LAMPS}",
               f"_image_transport:={transport}"]
        scenario = os.path.join(self.logs.name, f"servo-{size}.yaml")
        with open(f"{DATA}/scenarios/servo.yaml") as file, open(scenario, "w") as copy:
            copy.write(file.read().replace("../", DATA + "/").replace(SIZE, size))
        simulator = [f"__ns:=/{robot}", f"_scenario:={scenario}", f"_start_x:={x}", f"_start_y:={y}",
                     f"_jpeg_quality:={quality}"]
        for node, arguments in (("simulator", simulator), ("CamKF", own), ("ID_recognition", own),
                                ("vlc_locator", own + [f"_base_frame:={robot}/base_link"])):
            self.start(node, arguments, where[node], master)

    def seconds(self, name):
        """Processor time of all nodes of that name so far."""
        ticks = 0
        for each, process in self.all:
            if each == name:
                with open(f"/proc/{process.pid}/stat") as file:
                    fields = file.read().rsplit(")", 1)[1].split()
                ticks += int(fields[11]) + int(fields[12])
        return ticks / os.sysconf("SC_CLK_TCK")

    def close(self):
        for _, process in reversed(self.all):
            try:
                os.killpg(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            process.wait()


LISTEN = """
import bisect, json, sys, time
import rospy
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
names, settled, seconds = sys.argv[1].split(","), float(sys.argv[2]), float(sys.argv[3])
truth, heard = {n: [] for n in names}, {n: [] for n in names}
rospy.init_node("listener", disable_signals=True)
for n in names:
    rospy.Subscriber(f"/{n.split('/')[0]}/ground_truth", PoseStamped, lambda m, n=n: truth[n].append(
        (m.header.stamp.to_sec(), m.pose.position.x, m.pose.position.y)))
    rospy.Subscriber(f"/{n}/location", PoseWithCovarianceStamped, lambda m, n=n: heard[n].append(
        (m.header.stamp.to_sec(), time.time(), m.pose.pose.position.x, m.pose.pose.position.y)))
time.sleep(settled)
begin = time.time()
time.sleep(seconds)
rows = {}
for n in names:
    errors, delays, at_stamp = [], [], {}
    truth[n].sort()
    for stamp, at, x, y in [h for h in heard[n] if h[1] >= begin]:
        i = bisect.bisect(truth[n], (stamp,))
        if 0 < i < len(truth[n]):
            a, b = truth[n][i - 1], truth[n][i]
            s = (stamp - a[0]) / (b[0] - a[0])
            errors.append(((a[1] + s * (b[1] - a[1]) - x) ** 2 + (a[2] + s * (b[2] - a[2]) - y) ** 2) ** 0.5)
            at_stamp[f"{stamp:.6f}"] = errors[-1]
        delays.append(at - stamp)
    rows[n] = {"poses": len(delays), "errors": sorted(errors), "delays": sorted(delays), "at": at_stamp,
               "end": truth[n][-1][1:]}
print(json.dumps(rows))
"""


def listen(nodes, robots, host=None, master="127.0.0.1"):
    import json

    environment = dict(os.environ, PATH="/usr/bin:" + os.environ["PATH"], ROS_MASTER_URI=f"http://{master}:11397",
                       ROS_IP=Link.ADDRESSES.get(host, "127.0.0.1"), ROS_LOG_DIR=nodes.logs.name)
    prefix = ["ip", "netns", "exec", host] if host else []
    out = subprocess.run(prefix + ["/usr/bin/python3", "-c", LISTEN, ",".join(robots), str(SETTLED), str(SECONDS)],
                         env=environment,
                         stdout=subprocess.PIPE, check=True).stdout
    return json.loads(out.splitlines()[-1])


def rms(errors):
    return math.sqrt(sum(e * e for e in errors) / max(1, len(errors)))


def row(name, heard):
    if not heard["delays"] or not heard["errors"]:
        return f"| {name} | 0 | - | - | - | - |"
    middle = heard["delays"][len(heard["delays"]) // 2]
    late = heard["delays"][int(0.95 * len(heard["delays"]))]
    return (f"| {name} | {heard['poses'] / SECONDS:.1f} | {1e3 * rms(heard['errors']):.3f} | {1e3 * heard['errors'][-1]:.3f} "
            f"| {1e3 * middle:.0f} | {1e3 * late:.0f} |")


HEADER = ("| | poses a second | error, rms, mm | largest, mm | exposure to message, median, ms | 95 %, ms |\n"
          "|---|---|---|---|---|---|")


def robots(build, count):
    nodes = Nodes(build)
    try:
        nodes.start("roscore", ["-p", "11397"], program="/usr/bin/roscore")
        time.sleep(4)
        names = [f"robot{k + 1}" for k in range(count)]
        here = dict.fromkeys(("simulator", "CamKF", "ID_recognition", "vlc_locator"))
        for k, name in enumerate(names):
            nodes.robot(name, here, x=-0.35 + 0.15 * k, y=0.1 * (k % 3) - 0.1)
        before = {}
        timer = threading.Timer(SETTLED, lambda: before.update({n: nodes.seconds(n) for n in here}))
        timer.start()
        heard = listen(nodes, names)
        print(HEADER)
        for name in names:
            print(row(name, heard[name]))
        print("\n| node | of one core, for each robot, % |\n|---|---|")
        for name in here:
            print(f"| {name} | {100 * (nodes.seconds(name) - before[name]) / SECONDS / count:.1f} |")
    finally:
        nodes.close()


def sizes(build):
    print(HEADER)
    for size in (SIZE, "2048x1536"):
        for transport in ("raw", "compressed"):
            nodes = Nodes(build)
            try:
                nodes.start("roscore", ["-p", "11397"], program="/usr/bin/roscore")
                time.sleep(4)
                nodes.robot("robot", dict.fromkeys(("simulator", "CamKF", "ID_recognition", "vlc_locator")),
                            transport=transport, size=size)
                print(row(f"{size}, {transport}", listen(nodes, ["robot"])["robot"]), flush=True)
            finally:
                nodes.close()


def splits(build):
    robot, pc = "vlp-robot", "vlp-pc"
    camera = {"simulator": robot, "CamKF": pc, "ID_recognition": pc, "vlc_locator": pc}
    cases = (
        ("camera on the robot, the rest on the computer, PNG", "compressed", 0, camera),
        ("the same, JPEG of quality 90", "compressed", 90, camera),
        ("the same, raw", "raw", 0, camera),
        ("tracker on the robot, ids and locator on the computer", "raw", 0, dict(camera, CamKF=robot)),
        ("all on the robot", "raw", 0, dict.fromkeys(camera, robot)),
    )
    print(HEADER[:HEADER.index("\n")] + " from the robot, Mbit/s | to it, Mbit/s | stands from the line's end, mm | "
          "one process, same pictures, rms, mm; the nodes' over its |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for name, transport, quality, where in cases:
        link, nodes = Link(), Nodes(build)
        try:
            nodes.start("roscore", ["-p", "11397"], pc, Link.ADDRESSES[pc], "/usr/bin/roscore")
            time.sleep(5)
            nodes.robot("robot", where, Link.ADDRESSES[pc], transport, quality=quality)
            nodes.start("vlp", ["__ns:=/robot", f"_rig:={DATA}/rigs/ub300-{SIZE}.yaml", f"_lamps:={LAMPS}",
                                "_base_frame:=one"] + [f"{topic}:=one/{topic}" for topic in
                                                       ("location", "vlp_location", "lamps", "path")],
                        robot, Link.ADDRESSES[pc])
            before = {}

            def drive():
                before.update(link.sent)
                nodes.start("vlp_servo", ["__ns:=/robot", f"_path:={DATA}/paths/line-a.yaml", "_speed:=0.05"],
                            where["vlc_locator"], Link.ADDRESSES[pc])

            threading.Timer(SETTLED, drive).start()
            both = listen(nodes, ["robot", "robot/one"], pc, Link.ADDRESSES[pc])
            heard, one = both["robot"], both["robot/one"]["at"]
            common = [stamp for stamp in heard["at"] if stamp in one]
            own, other = rms([heard["at"][s] for s in common]), rms([one[s] for s in common])
            rate = {n: 8e-6 * (link.sent[n] - before[n]) / SECONDS for n in before}
            print(row(name, heard), f"{rate[robot]:.2f} | {rate[pc]:.2f} | {1e3 * math.dist(heard['end'], LINE_END):.1f} "
                  f"| {1e3 * other:.4f}; {own / other if other else math.nan:.2f} |", flush=True)
        finally:
            nodes.close()
            link.close()


if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[2] not in ("robots", "sizes", "splits"):
        sys.exit(__doc__)
    if sys.argv[2] == "robots":
        robots(sys.argv[1], int(sys.argv[3]) if len(sys.argv) > 3 else 5)
    elif sys.argv[2] == "sizes":
        sizes(sys.argv[1])
    else:
        splits(sys.argv[1])
