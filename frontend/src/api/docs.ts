/** The API's description to read and to try, from the service that it describes and nowhere else. */

import SwaggerUI from "swagger-ui-dist/swagger-ui-es-bundle.js";
import "swagger-ui-dist/swagger-ui.css";

SwaggerUI({
  dom_id: "#docs",
  url: "/api/v1/openapi.json",
  deepLinking: true,
  // It would send the description to a server of its makers, to have it checked.
  validatorUrl: null,
});
