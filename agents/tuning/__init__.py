"""Search for hyperparameters with Optuna: what may be changed, one trial, and a study that survives being killed."""
