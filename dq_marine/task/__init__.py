"""What a task of a moving body is: start, action, memory, observation, reward and end. Plain functions on tuples."""
