"""What an agent is told by: sensors with noise, biases, rates and drop-outs."""
