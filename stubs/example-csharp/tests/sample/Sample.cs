using System;
using Fc;
using FcRuntime;

/// <summary>The program of the README, and a robot for it.</summary>
public static class Sample
{
    /// <summary>Prints the serial number.</summary>
    public static void Main()
    {
        var body = Bodies.Write(new RequestEnvelope { CmdTime = 1667823500544 }, new GetRobotSnRequest());
        var request = new Frame { Kind = Wire.Layout.KindOf("command"), Code = Operations.GetRobotSn.Code.Value, Id = 7, Data = body };
        byte[] received = Robot(request.Encode(Wire.Layout));

        var response = Frame.Decode(Wire.Layout, received);
        var opened = Bodies.Read(Shapes.ResponseEnvelope, Shapes.GetRobotSnResponse, response.Data, Wire.Layout.JsonDepth);
        Console.WriteLine(opened.Message.Data.RobotSn);
    }

    private static byte[] Robot(byte[] sent)
    {
        var request = Frame.Decode(Wire.Layout, sent);
        var message = new GetRobotSnResponse(new GetRobotSnResponseData("100132001234567"));
        request.IsResponse = true;
        request.Data = Bodies.Write(new ResponseEnvelope(1001), message);
        return request.Encode(Wire.Layout, true);
    }
}
