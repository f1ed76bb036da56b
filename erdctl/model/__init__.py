"""The paper's model and any list of effects: from motion and control to force. Names no effect."""
