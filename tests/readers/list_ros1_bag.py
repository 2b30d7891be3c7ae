"""Lists ROS 1 bags as python3-rosbag reads them: a line a message, "topic type log-time-ns stamp-ns"."""

import sys

import rosbag

for path in sys.argv[1:]:
    with rosbag.Bag(path) as bag:
        digests = {c.datatype: c.md5sum for c in bag._get_connections()}
        count = 0
        for topic, message, time in bag.read_messages():
            # Made from the definition in the bag: its digest is that which the bag tells.
            if message._md5sum != digests[message._type]:
                sys.exit(f"{message._type}: {message._md5sum}, in the bag {digests[message._type]}")
            header = message.transforms[0].header if topic == "/tf_static" else message.header
            print(topic, message._type, time.to_nsec(), header.stamp.to_nsec())
            count += 1
        print("#", count, "messages")
