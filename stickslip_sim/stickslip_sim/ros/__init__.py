"""The ROS 2 node: the only room that knows rclpy and the messages.  No physics in here."""
